#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

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

}  // namespace
}  // namespace rover
