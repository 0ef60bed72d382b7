# Tests and benchmark of the simulated vehicle and its sensors.
rover_test(vehicle_test
  SOURCES vehicle_slip_test.cpp vehicle_motion_test.cpp vehicle_contact_test.cpp vehicle_current_test.cpp
    vehicle_sensors_test.cpp pan_tilt_test.cpp
  LINK rover_vehicle_sim)

find_package(benchmark REQUIRED)
add_executable(vehicle_bench vehicle_bench.cpp)
target_link_libraries(vehicle_bench PRIVATE rover_vehicle_sim benchmark::benchmark)
set_target_properties(vehicle_bench PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bench)
