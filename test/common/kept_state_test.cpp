#include "common/bus/kept_state.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <rover/service_state_t.hpp>

namespace rover {
namespace {

using Bytes = KeptState::Bytes;

class KeptStateTest : public testing::Test {
 protected:
  KeptStateTest() : dir_(testing::TempDir() + "/kept_state_" + std::to_string(getpid())) {
    std::filesystem::create_directories(dir_);
    bus_.subscribeFunction(
        channel::kServiceState,
        +[](const lcm::ReceiveBuffer*, const std::string&, const service_state_t* m,
            std::vector<service_state_t>* out) { out->push_back(*m); },
        &told_);
  }
  ~KeptStateTest() override { std::filesystem::remove_all(dir_); }

  NodeOptions options() const { return {.name = "node", .run_dir = dir_}; }
  void drain() {
    while (bus_.handleTimeout(0) > 0) {
    }
  }

  std::string dir_;
  lcm::LCM bus_{"memq://"};
  std::vector<service_state_t> told_;
};

TEST_F(KeptStateTest, TheNextProcessFindsItAndTellsOfItOnce) {
  Node first(options(), bus_);
  KeptState kept(first);
  bool asked = false;
  kept.restore([&](const Bytes&) { return asked = true; });
  EXPECT_FALSE(asked);
  EXPECT_TRUE(kept.save({1, 2, 3}));
  EXPECT_FALSE(kept.due());  // not before a second has passed

  Node second(options(), bus_);
  KeptState found(second);
  Bytes restored;
  found.restore([&](const Bytes& bytes) {
    restored = bytes;
    return true;
  });
  EXPECT_EQ(restored, (Bytes{1, 2, 3}));
  found.tell();
  found.tell();
  drain();
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_EQ(told_[0].service, "node");
  EXPECT_EQ(told_[0].data, (Bytes{1, 2, 3}));
}

TEST_F(KeptStateTest, WhatIsOfNoUseIsNotTold) {
  Node first(options(), bus_);
  KeptState(first).save({9});
  Node second(options(), bus_);
  KeptState found(second);
  testing::internal::CaptureStdout();
  found.restore([](const Bytes&) { return false; });
  EXPECT_NE(testing::internal::GetCapturedStdout().find("CHECKPOINT unusable"), std::string::npos);
  found.tell();
  drain();
  EXPECT_TRUE(told_.empty());
}

TEST_F(KeptStateTest, WithoutARunFolderNothingIsKeptAndThatIsNoFailure) {
  Node node({.name = "node"}, bus_);
  KeptState kept(node);
  EXPECT_FALSE(kept.due());
  EXPECT_TRUE(kept.save({1}));
  kept.restore([](const Bytes&) { return ADD_FAILURE(), true; });
}

TEST_F(KeptStateTest, ADiskThatDoesNotTakeItIsSaid) {
  std::filesystem::remove_all(dir_);
  Node node(options(), bus_);
  testing::internal::CaptureStdout();
  EXPECT_FALSE(KeptState(node).save({1}));
  EXPECT_NE(testing::internal::GetCapturedStdout().find("CHECKPOINT not saved"), std::string::npos);
}

}  // namespace
}  // namespace rover
