#!/usr/bin/env bash
# ./rover new-service makes a service that builds, runs and passes its test, and refuses names that cannot be one.
. "$(dirname "$0")/lib.sh"

copy=$WORK/copy
mkdir "$copy"
cp -r "$SOURCE"/{CMakeLists.txt,.clang-format,cmake,lcmtypes,services,supervisor,tools,templates,examples,test,config} "$copy"
files_of_copy() { (cd "$copy" && find . -type f -exec sha256sum {} + | sort); }
files_of_copy >"$WORK/before"

refused() {  # WORDS NAME...
  local words=$1 status=0
  shift
  "$copy/tools/new_service/new_service.sh" "$@" >"$WORK/said" 2>&1 || status=$?
  [ $status = 2 ] || fail "'$*': exit status $status"
  [ "$(wc -l <"$WORK/said")" = 1 ] || fail "'$*': not one line: $(cat "$WORK/said")"
  grep -q "$words" "$WORK/said" || fail "'$*': no word of '$words': $(cat "$WORK/said")"
}
refused "takes one name"
refused "takes one name" one two
for bad in '' Slam two-parts _x x__y x_ 9x ../x 'a b' 'x;y' aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa; do
  refused "cannot be a service's name" "$bad"
done
for existing in slam rover_simulator supervisor common spy fuzz vehicle; do refused "already exists" "$existing"; done
refused "the build target runtime already exists" runtime
refused "the channel VO already exists" vo
refused "the namespace trav already exists" trav
refused "is a keyword of C++" switch
files_of_copy | cmp -s - "$WORK/before" || fail "a refused name changed files"

name=trip_odometer
"$copy/tools/new_service/new_service.sh" $name >"$WORK/said" || fail "not made: $(cat "$WORK/said")"
! grep -rn '@[A-Z]*@' "$copy"/{services,test}/$name "$copy/config/$name.yaml" "$copy/lcmtypes/${name}_t.lcm" ||
  fail "placeholders are left"
refused "already exists" $name
# The edited lists are read by the whole project.
cmake -S "$copy" -B "$WORK/whole" -G Ninja >"$WORK/said" 2>&1 || fail "the project is not configured: $(tail -5 "$WORK/said")"
for target in $name ${name}_test ${name}_node_test bad_messages_test; do
  ninja -C "$WORK/whole" -t inputs $target >"$WORK/said" || fail "no target $target: $(tail -1 "$WORK/said")"
  grep -q "$name" "$WORK/said" || fail "$target does not need the service"
done

cp "$SOURCE/test/integration/new_service.cmake" "$copy/CMakeLists.txt"
# So that ccache knows the same files in another folder.
export CCACHE_BASEDIR=$WORK CCACHE_NOHASHDIR=1
cmake -S "$copy" -B "$WORK/build" -G Ninja -DNAME=$name -DROVER_BUILD="$BUILD" >"$WORK/said" 2>&1 ||
  fail "the service is not configured: $(tail -5 "$WORK/said")"
ninja -C "$WORK/build" all unit_tests >"$WORK/said" || fail "the service is not built: $(tail -30 "$WORK/said")"
ctest --test-dir "$WORK/build" --output-on-failure >"$WORK/said" || fail "its tests fail: $(cat "$WORK/said")"
[ "$(grep -c Passed "$WORK/said")" = 2 ] || fail "not two tests: $(cat "$WORK/said")"

program=$WORK/build/bin/$name
"$program" --config "$copy/config" --parameters yaml | diff - "$copy/config/$name.yaml" || fail "config/$name.yaml differs"
"$program" --config "$copy/config" --parameters markdown >"$WORK/table"
sed '1,/<!-- parameters -->/d; /<!-- \/parameters -->/,$d' "$copy/services/$name/README.md" | diff - "$WORK/table" ||
  fail "the table of the README differs"
"$program" --config "$copy/config" --bus "$BUS" >"$WORK/log" 2>&1 &
process=$!
for _ in $(seq 100); do
  ! grep -q " $name STARTED" "$WORK/log" || break
  sleep 0.1
done
kill -TERM $process
wait $process || fail "it ends with $?: $(cat "$WORK/log")"
grep -q " $name STOPPED" "$WORK/log" || fail "it did not run: $(cat "$WORK/log")"
echo "a new service builds, runs and passes its test"
