# Who may use whom: cores know no middleware, services know neither tools nor other services. What is linked is checked
# at each configuration, what is included at each build (check_includes.sh).

# Adds all that target links, directly or not, to the list named out.
function(rover_links_of target out)
  set(seen ${${out}})
  foreach(property LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
    get_target_property(links ${target} ${property})
    foreach(link ${links})
      string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" link "${link}")
      if(TARGET ${link} AND NOT link IN_LIST seen)
        list(APPEND seen ${link})
        rover_links_of(${link} seen)
      endif()
    endforeach()
  endforeach()
  set(${out} ${seen} PARENT_SCOPE)
endfunction()

# The folder of a target below the project's, down to the service or tool: services/stereo, tools/spy.
function(rover_home_of target out)
  get_target_property(home ${target} SOURCE_DIR)
  file(RELATIVE_PATH home ${CMAKE_SOURCE_DIR} "${home}")
  string(REGEX MATCH "^(services|tools)/[^/]+|^[^/]+" home "${home}")
  set(${out} "${home}" PARENT_SCOPE)
endfunction()

function(rover_check_layers)
  get_property(cores GLOBAL PROPERTY ROVER_CORES)
  get_property(nodes GLOBAL PROPERTY ROVER_NODES)
  foreach(target ${cores} ${nodes})
    set(links)
    rover_links_of(${target} links)
    rover_home_of(${target} home)
    foreach(link ${links})
      if(target IN_LIST cores AND link MATCHES "^(rover_bus|rover_lcmtypes|PkgConfig::LCM|PkgConfig::YAML_CPP)$")
        message(SEND_ERROR "${home}: the core ${target} links the bus (${link})")
      endif()
      rover_home_of(${link} link_home)
      if(home MATCHES "^(services|supervisor)" AND link_home MATCHES "^(tools/|services/|supervisor)"
          AND NOT link_home STREQUAL home AND NOT link_home STREQUAL services/common)
        message(SEND_ERROR "${home}: ${target} links ${link} of ${link_home}")
      endif()
    endforeach()
  endforeach()
  rover_check_truth()
endfunction()

# Maps made from the true surface are for benches: tools/one_process and test/ alone.
function(rover_check_truth)
  get_property(programs GLOBAL PROPERTY ROVER_PROGRAMS)
  foreach(program ${programs})
    set(links)
    rover_links_of(${program} links)
    rover_home_of(${program} home)
    if(links MATCHES "truth_perception" AND NOT home MATCHES "^(tools/one_process|test)$")
      message(SEND_ERROR "${home}: ${program} links truth_perception, which reads the true world")
    endif()
  endforeach()
endfunction()

add_custom_target(check_includes ALL
  COMMAND ${CMAKE_SOURCE_DIR}/cmake/check_includes.sh ${CMAKE_SOURCE_DIR} COMMENT "who includes whom")
