rover_core(rover_barrier SOURCES barrier.cpp LINK rover_common)
rover_core(rover_simulator_core SOURCES sensor_faults.cpp simulated_rover.cpp LINK rover_barrier rover_world rover_vehicle_sim
  rover_camera_sim)
add_library(rover_simulator_node STATIC simulator.cpp simulator_faults.cpp world_faults.cpp process_faults.cpp
  command_inbox.cpp convert.cpp)
target_link_libraries(rover_simulator_node PUBLIC rover_simulator_core rover_bus rover_scenario nlohmann_json::nlohmann_json)
add_executable(rover_simulator main.cpp)
target_link_libraries(rover_simulator PRIVATE rover_simulator_node)
rover_program(rover_simulator)
