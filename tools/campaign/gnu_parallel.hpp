// GNU parallel: on this machine, or on those of a file of SSH logins.
#pragma once

#include <memory>

#include "common/bus/child.hpp"
#include "tools/campaign/engine.hpp"

namespace rover::campaign {

class GnuParallel : public Engine {
 public:
  void start(const Batch& batch) override;
  bool running() override;
  void stop() override;

 private:
  std::unique_ptr<Child> child_;
  std::string log_;
};

}  // namespace rover::campaign
