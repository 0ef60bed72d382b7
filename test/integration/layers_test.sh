#!/usr/bin/env bash
# The build refuses a service that includes or links another service or a tool, and a core that links the bus.
. "$(dirname "$0")/lib.sh"

copy=$WORK/copy
mkdir "$copy"
cp -r "$SOURCE"/{CMakeLists.txt,cmake,lcmtypes,services,supervisor,tools,examples,test,config} "$copy"

include_is_refused() {  # FILE INCLUDED
  printf '#include "%s"\n' "$2" >>"$copy/$1"
  ! "$copy/cmake/check_includes.sh" "$copy" >"$WORK/said" 2>&1 || fail "$1 may include $2"
  grep -q "^$1:[0-9]*: .* may not include $2\$" "$WORK/said" || fail "no file and line: $(cat "$WORK/said")"
  cp "$SOURCE/$1" "$copy/$1"
}
"$copy/cmake/check_includes.sh" "$copy" || fail "the tree itself is refused"
include_is_refused services/slam/slam.cpp stereo/config.hpp
include_is_refused services/slam/node.hpp tools/report/track.hpp
include_is_refused services/recorder/node.cpp supervisor/fdir.hpp
include_is_refused services/common/core/frames.cpp localization/filter.hpp
include_is_refused supervisor/fdir.cpp localization/filter.hpp
include_is_refused tools/report/track.cpp tools/truth_perception/nodes.hpp
include_is_refused services/localization/filter.cpp ../supervisor/fdir.hpp

link_is_refused() {  # FILE LINE MESSAGE
  echo "$2" >>"$copy/$1"
  ! cmake -S "$copy" -B "$WORK/build" -G Ninja >"$WORK/said" 2>&1 || fail "$2 is configured"
  tr -s ' \n' ' ' <"$WORK/said" | grep -q "$3" || fail "'$3' is not reported: $(tail -5 "$WORK/said")"
  cp "$SOURCE/$1" "$copy/$1"
}
link_is_refused services/slam/CMakeLists.txt 'target_link_libraries(slam_core PUBLIC rover_bus)' \
  'services/slam: the core slam_core links the bus'
link_is_refused services/slam/CMakeLists.txt 'target_link_libraries(slam_core PRIVATE traversability_core)' \
  'services/slam: slam_core links traversability_core of services/traversability'
link_is_refused services/recorder/CMakeLists.txt 'target_link_libraries(recorder_node PUBLIC replay_lib)' \
  'services/recorder: recorder_node links replay_lib of tools/replay'
link_is_refused tools/spy/CMakeLists.txt 'target_link_libraries(rover_spy PRIVATE truth_perception)' \
  'tools/spy: rover_spy links truth_perception, which reads the true world'
echo "each wrong include and link is refused"
