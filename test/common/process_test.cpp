#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "common/bus/child.hpp"
#include "common/bus/s6_client.hpp"

namespace rover {
namespace {

TEST(Process, WhatItComputesIsTold) {
  const double before = process_cpu_s(getpid());
  volatile double sum = 0.0;
  int rounds = 0;
  for (; rounds < 1'000'000 && process_cpu_s(getpid()) < before + 0.05; ++rounds)
    for (int i = 0; i < 10'000; ++i) sum = sum + std::sqrt(static_cast<double>(i));
  EXPECT_LT(rounds, 1'000'000) << "computed for long, and nothing was reported";
  EXPECT_GT(rounds, 0);
}

TEST(Process, NobodyHasComputedNothing) {
  EXPECT_EQ(process_cpu_s(0), 0.0);
  EXPECT_EQ(process_cpu_s(-1), 0.0);
}

// GNU parallel ends with 255, which is no signal.
TEST(Process, AnExitStatusIsNotTakenForASignal) {
  const auto end_of = [](const std::string& command) {
    Child child({"sh", "-c", command}, "/dev/null");
    while (child.running()) sleep_s(0.01);
    return status_text(child.status());
  };
  EXPECT_EQ(end_of("exit 2"), "exit status 2");
  EXPECT_EQ(end_of("exit 255"), "exit status 255");
  EXPECT_EQ(end_of("kill -9 $$"), "killed by signal 9");
  EXPECT_EQ(end_of("exit 127"), "could not be started");
}

}  // namespace
}  // namespace rover
