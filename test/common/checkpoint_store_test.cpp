#include "common/bus/checkpoint_store.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <rover/service_state_t.hpp>

namespace rover {
namespace {

using Bytes = CheckpointStore::Bytes;

class CheckpointStoreTest : public testing::Test {
 protected:
  CheckpointStoreTest() : dir_(testing::TempDir() + "/checkpoint_store_" + std::to_string(getpid())) {
    std::filesystem::create_directories(dir_);
    bus_.subscribeFunction(
        channel::kServiceState,
        +[](const lcm::ReceiveBuffer*, const std::string&, const service_state_t* m,
            std::vector<service_state_t>* out) { out->push_back(*m); },
        &published_);
  }
  ~CheckpointStoreTest() override { std::filesystem::remove_all(dir_); }

  NodeOptions options() const { return {.name = "node", .run_dir = dir_}; }
  void drain() {
    while (bus_.handleTimeout(0) > 0) {
    }
  }

  std::string dir_;
  lcm::LCM bus_{"memq://"};
  std::vector<service_state_t> published_;
};

TEST_F(CheckpointStoreTest, NextProcessRestoresAndPublishesOnce) {
  Node first(options(), bus_);
  CheckpointStore kept(first);
  bool asked = false;
  kept.restore([&](const Bytes&) { return asked = true; });
  EXPECT_FALSE(asked);
  EXPECT_TRUE(kept.save({1, 2, 3}));
  EXPECT_FALSE(kept.due());  // not before a second has passed

  Node second(options(), bus_);
  CheckpointStore found(second);
  Bytes restored;
  found.restore([&](const Bytes& bytes) {
    restored = bytes;
    return true;
  });
  EXPECT_EQ(restored, (Bytes{1, 2, 3}));
  found.publish_restored();
  found.publish_restored();
  drain();
  ASSERT_EQ(published_.size(), 1u);
  EXPECT_EQ(published_[0].service, "node");
  EXPECT_EQ(published_[0].data, (Bytes{1, 2, 3}));
}

TEST_F(CheckpointStoreTest, UnusableCheckpointIsNotPublished) {
  Node first(options(), bus_);
  CheckpointStore(first).save({9});
  Node second(options(), bus_);
  CheckpointStore found(second);
  testing::internal::CaptureStdout();
  found.restore([](const Bytes&) { return false; });
  EXPECT_NE(testing::internal::GetCapturedStdout().find("CHECKPOINT unusable"), std::string::npos);
  found.publish_restored();
  drain();
  EXPECT_TRUE(published_.empty());
}

TEST_F(CheckpointStoreTest, DamagedFileIsLoggedAndHasNoBytes) {
  Node first(options(), bus_);
  CheckpointStore(first).save({1, 2, 3});
  std::filesystem::resize_file(dir_ + "/node.ckpt", 5);
  Node second(options(), bus_);
  std::vector<Bytes> passed;
  testing::internal::CaptureStdout();
  CheckpointStore(second).restore([&](const Bytes& bytes) {
    passed.push_back(bytes);
    return false;
  });
  EXPECT_NE(testing::internal::GetCapturedStdout().find("CHECKPOINT unusable"), std::string::npos);
  EXPECT_EQ(passed, std::vector<Bytes>{{}});
}

TEST_F(CheckpointStoreTest, WithoutRunFolderSaveDoesNothing) {
  Node node({.name = "node"}, bus_);
  CheckpointStore kept(node);
  EXPECT_FALSE(kept.due());
  EXPECT_TRUE(kept.save({1}));
  kept.restore([](const Bytes&) { return ADD_FAILURE(), true; });
}

TEST_F(CheckpointStoreTest, SaveReportsFullDisk) {
  std::filesystem::remove_all(dir_);
  Node node(options(), bus_);
  testing::internal::CaptureStdout();
  EXPECT_FALSE(CheckpointStore(node).save({1}));
  EXPECT_NE(testing::internal::GetCapturedStdout().find("CHECKPOINT not saved"), std::string::npos);
}

}  // namespace
}  // namespace rover
