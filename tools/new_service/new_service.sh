#!/usr/bin/env bash
# new_service.sh NAME: makes a service with its message and test from templates/service, and adds it to the lists of
# services and channels. All or nothing: what is refused changes no file. Called by ./rover new-service.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."

refuse() {
  echo "rover: $1; $2" >&2
  exit 2
}
KEYWORDS=" alignas alignof and asm auto bool break case catch char class compl concept const constexpr consteval constinit
 continue default delete do double else enum explicit export extern false float for friend goto if inline int long
 mutable namespace new noexcept not operator or private protected public register requires return short signed
 sizeof static struct switch template this throw true try typedef typeid typename union unsigned using virtual void
 volatile while xor rover "

[ $# -eq 1 ] || refuse "new-service takes one name" "see ./rover new-service --help"
name=$1
[[ $name =~ ^[a-z][a-z0-9]*(_[a-z0-9]+)*$ && ${#name} -le 32 ]] ||
  refuse "'$name' cannot be a service's name" "lower-case letters, digits and single underscores are expected, as in visual_odometry"
class=$(sed -E 's/(^|_)(.)/\U\2/g' <<<"$name")
channel=${name^^}
[[ ${KEYWORDS//$'\n'/} != *" $name "* ]] || refuse "'$name' is a keyword of C++" "choose another name"
for path in "services/$name" "tools/$name" "test/$name" "$name" "config/$name.yaml" "lcmtypes/${name}_t.lcm"; do
  [ ! -e "$path" ] || refuse "$path already exists" "choose another name"
done
CHANNELS=services/common/bus/channels.hpp
! grep -qE "\bk$class\[\]|\"$channel\"" "$CHANNELS" || refuse "the channel $channel already exists" "choose another name"
sources=(CMakeLists.txt cmake lcmtypes services supervisor tools examples test)
targets="(rover_[a-z]+|add_(library|executable|custom_target))\(${name}(_core|_node|_test|_node_test)?\b"
! grep -rqE --include=CMakeLists.txt --include='*.cmake' "$targets" "${sources[@]}" ||
  refuse "the build target $name already exists" "choose another name"
! grep -rqE --include='*.[ch]pp' "\bnamespace (rover::)?$name\b" services supervisor test ||
  refuse "the namespace $name already exists" "choose another name"

made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT

fill() {  # TEMPLATE FILE
  mkdir -p "$made/$(dirname "$2")"
  sed "s/@NAME@/$name/g; s/@CLASS@/$class/g; s/@CHANNEL@/$channel/g" "templates/service/$1" >"$made/$2"
}
for file in CMakeLists.txt README.md main.cpp node.hpp node.cpp config.hpp config.cpp; do
  fill "service/$file" "services/$name/$file"
done
for suffix in hpp cpp; do fill "service/core.$suffix" "services/$name/$name.$suffix"; done
fill config.yaml "config/$name.yaml"
fill message.lcm "lcmtypes/${name}_t.lcm"
fill test/CMakeLists.txt "test/$name/CMakeLists.txt"
fill test/core_test.cpp "test/$name/${name}_test.cpp"
fill test/node_test.cpp "test/$name/node_test.cpp"

add_to() {  # FILE SED_SCRIPT...
  local file=$1 script
  mkdir -p "$made/$(dirname "$file")"
  cp "$file" "$made/$file"
  for script in "${@:2}"; do
    sed -E "$script" "$made/$file" >"$made/edited"
    ! cmp -s "$made/$file" "$made/edited" || refuse "$file: no place found for the new service" "its list has changed; correct tools/new_service/new_service.sh"
    cat "$made/edited" >"$made/$file"
  done
  rm "$made/edited"
}
add_to CMakeLists.txt "/^set\(ROVER_SERVICES /,/\)\$/ s/\)\$/ $name)/"
add_to services/common/bus/service_names.hpp "/kServiceNames = \{/,/\};/ s/\};/, \"$name\"};/"
add_to supervisor/fdir.hpp "s/( optional_services = \{[^}]*)\}/\1, \"$name\"}/"
add_to config/supervisor.yaml "s/^(optional_services: [^#]*[a-z])/\1 $name/"
! grep -q '^| `optional_services`' supervisor/README.md ||
  add_to supervisor/README.md "s/^(\| \`optional_services\` \| [a-z_ ]*[a-z])/\1 $name/"
add_to "$CHANNELS" "s|^}  // namespace|inline constexpr char k$class[] = \"$channel\";  // ${name}_t\n\n&|"
add_to services/common/bus/channel_types.cpp "s|^#include <rover/cloud_t.hpp>|&\n#include <rover/${name}_t.hpp>|" \
  "/kTypes = \{/,/^  \};/ s/^  \};/      {channel::k$class, carries<${name}_t>()},\n&/"
add_to test/integration/bad_messages_test.cpp "s|^#include \"stereo/node.hpp\"|&\n#include \"$name/node.hpp\"|" \
  "/kFactories = \{/,/^  \};/ s/^  \};/      {\"$name\", [](Node\& n) { return $name::make_$name(n, kConfig); }},\n&/"

cp .clang-format "$made"
! command -v clang-format >/dev/null || (cd "$made" && find . -name '*.[ch]pp' -exec clang-format -i {} +)
rm "$made/.clang-format"
cp -r "$made/." .
echo "made services/$name, test/$name, config/$name.yaml and lcmtypes/${name}_t.lcm; added to the lists of services and channels:"
(cd "$made" && find CMakeLists.txt config/supervisor.yaml supervisor services/common test/integration -type f)
echo "next: ninja -C build $name ${name}_test ${name}_node_test && ctest --test-dir build -R ^${name}_, then docs/contributing.md"
