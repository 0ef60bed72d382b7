# The cameras' tests and benchmark.
rover_test(camera_test THREADS SOURCES camera_test.cpp camera_parts_test.cpp camera_stereo_test.cpp geometric_test.cpp ground_picture_test.cpp
  LINK rover_camera_sim rover_orbital_picture)

find_package(benchmark REQUIRED)
add_executable(camera_bench camera_bench.cpp)
target_link_libraries(camera_bench PRIVATE rover_camera_sim benchmark::benchmark)
set_target_properties(camera_bench PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bench)
if(TARGET point_cloud_node)
  rover_benchmark(perception_study SOURCES perception_study.cpp
    LINK rover_camera_sim rover_scenario stereo_node point_cloud_node report_io)
endif()
