// Tests the fuzzer: failures of a parser are found, stored and reproducible.
#include "run_inputs.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "common/bus/config.hpp"

namespace rover::fuzz {
namespace {

namespace fs = std::filesystem;

class RunInputs : public testing::Test {
 protected:
  RunInputs() {
    std::string name = (fs::temp_directory_path() / "rover-fuzz-test-XXXXXX").string();
    dir_ = mkdtemp(name.data());
  }
  ~RunInputs() override { fs::remove_all(dir_); }

  // A parser that fails only for input 7.
  Outcome with(const std::function<void(Scratch&)>& fault) {
    const auto number = std::make_shared<int>(0);
    Parser parser{"p", {{"f", "seed: 12\nlevel: auto\n"}}, {"---"}, [=](const Input& input, Scratch& scratch) {
                    scratch.write("f", input.bytes);
                    if ((*number)++ == 7) fault(scratch);
                    throw ConfigError("f:1: refused");
                  }};
    Campaign campaign;
    campaign.inputs = 10;
    campaign.max_cpu_s = 2.0;
    campaign.max_memory_mb = 300.0;
    campaign.findings_dir = dir_ / "findings";
    return run_inputs(parser, campaign);
  }

  void expect_found(const Outcome& outcome, const std::string& what) {
    EXPECT_EQ(outcome.inputs, 10U);
    ASSERT_EQ(outcome.findings.size(), 1U);
    EXPECT_EQ(outcome.findings[0].number, 7U);
    EXPECT_NE(outcome.findings[0].what.find(what), std::string::npos) << outcome.findings[0].what;
    EXPECT_TRUE(fs::exists(outcome.findings[0].file));
  }

  fs::path dir_;
};

TEST_F(RunInputs, NothingIsFoundWhereNothingIsWrong) {
  const Outcome outcome = with([](Scratch&) {});
  EXPECT_EQ(outcome.inputs, 10U);
  EXPECT_EQ(outcome.refused, 10U);
  EXPECT_TRUE(outcome.findings.empty());
  EXPECT_FALSE(fs::exists(dir_ / "findings"));
}

TEST_F(RunInputs, ACrashIsFound) {
  expect_found(with([](Scratch&) { std::abort(); }), "");
}

TEST_F(RunInputs, AnEndlessLoopIsFound) {
  expect_found(with([](Scratch&) {
                 for (volatile bool going = true; going;) {
                 }
               }),
               "computes for too long");
}

TEST_F(RunInputs, WasteOfMemoryIsFound) {
  expect_found(with([](Scratch&) { std::vector<char>(400'000'000, 'x').back() = 'y'; }), " MB");
}

TEST_F(RunInputs, AnExceptionThatIsNoRefusalIsFound) {
  expect_found(with([](Scratch&) { throw std::out_of_range("stoi"); }), "no refusal: stoi");
}

TEST_F(RunInputs, AnInputThatIsWrittenOverIsFound) {
  expect_found(with([](Scratch& scratch) { std::ofstream(scratch.dir() + "/f") << "mine"; }), "written over: f");
}

TEST(Mutated, TheSameNumberIsTheSameInput) {
  const std::vector<Input> corpus = {{"a", "seed: 12\nlevel: auto\n"}, {"b", "x: [1, 2]\n"}};
  size_t different = 0;
  for (std::uint64_t n = 0; n < 500; ++n) {
    EXPECT_EQ(mutated(corpus, {"---"}, 3, n).bytes, mutated(corpus, {"---"}, 3, n).bytes);
    different += mutated(corpus, {"---"}, 3, n).bytes != mutated(corpus, {"---"}, 4, n).bytes ? 1 : 0;
  }
  EXPECT_GT(different, 400U);
}

}  // namespace
}  // namespace rover::fuzz
