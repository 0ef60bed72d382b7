// From a scenario to a simulated rover, and from its run to the summary in the run's folder.
#pragma once

#include <memory>
#include <string>

#include "rover_simulator/simulator.hpp"
#include "rover_simulator/world/scenario.hpp"

namespace rover {

// Throws ConfigError: the cameras cannot be rendered, or a file of the configuration is invalid.
std::unique_ptr<SimulatedRover> make_simulated_rover(const Scenario& scenario, const std::string& config_dir,
                                                     std::uint64_t seed);
GroundAppearanceConfig ground_appearance(const Scenario& scenario, std::uint64_t seed);

// Adds what the scenario says of faults and the end of the run.
SimulatorOptions with_scenario(SimulatorOptions options, const Scenario& scenario);

// Renders scenario.orbital_picture of the world to a GeoTIFF, on all cores. Throws DtmError.
void write_orbital_picture(const Scenario& scenario, std::uint64_t seed, const std::string& file);

void write_summary(const std::string& run_dir, const SimulationSummary& summary);

}  // namespace rover
