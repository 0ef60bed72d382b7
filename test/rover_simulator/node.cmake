# The simulator on the bus.
rover_test(simulator_node_test THREADS SOURCES node_test.cpp barrier_test.cpp faults_test.cpp fault_parts_test.cpp navcam_test.cpp LINK rover_simulator_node)
