// The common part of every service's main: arguments, configuration, bus, signals, exit status.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "common/bus/config.hpp"
#include "common/bus/node.hpp"
#include "common/bus/parameters.hpp"

namespace rover {

// Inputs of a service's constructor.
struct NodeContext {
  Node& node;
  std::string config_dir;  // contains vehicle.yaml, <service>.yaml, ...
};

// Builds the service on the node and returns the object that keeps it alive.
using NodeFactory = std::function<std::shared_ptr<void>(const NodeContext&)>;

// Describes the service's parameters in the list: its load_config.
using ConfigLoader = std::function<void(const std::string& config_dir, ParameterList* list)>;

// The bus of config/bus.yaml.
std::string load_bus_url(const std::string& config_dir);

// Larger than the boot number of any process started earlier.
std::int64_t boot_id_from_clock();

// Exit status 0 at SIGTERM or SIGINT, 2 on bad arguments or configuration, 1 on an error at run time.
int node_main(int argc, char** argv, const std::string& service, const ConfigLoader& describe,
              const NodeFactory& factory);

}  // namespace rover
