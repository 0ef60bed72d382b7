# Tests of the world: elevation, rocks, soils, files, scenarios.
rover_test(world_test SOURCES world_noise_test.cpp world_rocks_test.cpp world_surface_test.cpp world_orbital_map_test.cpp
  LINK rover_world)
rover_test(world_files_test SOURCES world_scenario_test.cpp LINK rover_scenario)
