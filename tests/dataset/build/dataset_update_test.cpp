#include <csignal>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/build/dataset_builder.hpp"
#include "dataset/build/dataset_merge.hpp"
#include "foundation/errors.hpp"
#include "foundation/processes/child_exit.hpp"
#include "tests/sensors/test_flight.hpp"
#include "tests/support/file_text.hpp"
#include "tests/support/programs.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Three short flights, and a data set of them.
class DatasetUpdate : public ::testing::Test {
 protected:
  DatasetUpdate() {
    config_.depth_map.crop_px = 32;
    config_.depth_map.every_nth_image = 1;
    for (const char* name : {"a", "b", "c"}) {
      FlightOptions options;
      options.duration_s = 1.5;
      write_flight(log(name), options);
    }
  }
  fs::path log(const std::string& name) const { return folder_.path() / (name + ".bag"); }
  BuildResult build(const std::vector<fs::path>& logs, const fs::path& output) const {
    return build_dataset(config_, small_rig(), logs, output);
  }
  BuildResult build(const std::vector<fs::path>& logs) const { return build(logs, data_); }
  std::string error_of(const std::vector<fs::path>& logs) const {
    return message_of<DataError>([&] { build(logs); });
  }
  ScratchFolder folder_;
  fs::path data_ = folder_.path() / "data";
  DatasetConfig config_;
};

/// When each of a flight's files was written.
std::vector<fs::file_time_type> write_times(const fs::path& dir) {
  std::vector<fs::file_time_type> times;
  for (const auto& entry : fs::recursive_directory_iterator(dir)) {
    if (entry.is_regular_file()) times.push_back(entry.last_write_time());
  }
  return times;
}

TEST_F(DatasetUpdate, AnotherFlightIsAddedAndTheOldOnesStayUntouched) {
  build({log("a"), log("b")});
  const auto before = write_times(data_ / "a");
  const BuildResult result = build({log("a"), log("b"), log("c")});
  EXPECT_THAT(result.built, ElementsAre("c"));
  EXPECT_THAT(result.kept, ElementsAre("a", "b"));
  EXPECT_EQ(write_times(data_ / "a"), before);
  build({log("a"), log("b"), log("c")}, folder_.path() / "at_once");
  EXPECT_EQ(read_tree(data_), read_tree(folder_.path() / "at_once"));
  EXPECT_FALSE(fs::exists(folder_.path() / "data.partial"));
}

TEST_F(DatasetUpdate, FlightsThatAreNotNamedStay) {
  build({log("a"), log("b")});
  const BuildResult result = build({log("c")});
  EXPECT_THAT(result.built, ElementsAre("c"));
  EXPECT_EQ(read_dataset_info(data_).flights.size(), 3u);
}

TEST_F(DatasetUpdate, WhatChangesTheSamplesRebuildsThem) {
  build({log("a"), log("b")});
  config_.depth_map.window_after_s = 0.5;
  EXPECT_THAT(error_of({log("c")}), AllOf(HasSubstr("flight a"), HasSubstr("another configuration")));
  EXPECT_THAT(build({log("a"), log("b")}).built, ElementsAre("a", "b"));
  EXPECT_EQ(read_dataset_info(data_).window_after_s, 0.5);
  build({log("a"), log("b")}, folder_.path() / "anew");
  EXPECT_EQ(read_tree(data_), read_tree(folder_.path() / "anew"));
}

TEST_F(DatasetUpdate, WhatDoesNotChangeTheSamplesRebuildsNothing) {
  build({log("a")});
  config_.png_compression = 5;
  config_.limits.max_silence_s = 60;
  EXPECT_THAT(build({log("a")}).built, IsEmpty());
}

TEST_F(DatasetUpdate, AnotherRigRebuilds) {
  build({log("a")});
  Rig rig = small_rig();
  rig.lidar0->timeshift_s = 0.01;
  EXPECT_THAT(build_dataset(config_, rig, {log("a")}, data_).built, ElementsAre("a"));
}

TEST_F(DatasetUpdate, TheContentOfALogDecidesNotItsDate) {
  build({log("a"), log("b")});
  fs::last_write_time(log("a"), fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_THAT(build({log("a"), log("b")}).built, IsEmpty());
  std::string bytes = test::file_text(log("b"));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] + 1);
  write_bytes(log("b"), bytes);
  EXPECT_THAT(build({log("a"), log("b")}).built, ElementsAre("b"));
}

TEST_F(DatasetUpdate, TrueDepthThatAppearsRebuilds) {
  build({log("a")});
  fs::create_directories(folder_.path() / "a.truth" / "depth");
  EXPECT_THAT(error_of({log("a")}), HasSubstr("no true depth"));
}

TEST_F(DatasetUpdate, ALogThatCannotBeReadDoesNotStopTheOthers) {
  write_bytes(log("b"), test::file_text(log("b")).substr(0, 5000));
  const BuildResult result = build({log("a"), log("b"), log("c"), folder_.path() / "none.bag"});
  EXPECT_THAT(result.built, ElementsAre("a", "c"));
  EXPECT_THAT(result.failed,
              ElementsAre(HasSubstr("b.bag"), AllOf(HasSubstr("none.bag"), HasSubstr("no such file"))));
  EXPECT_EQ(read_dataset_info(data_).flights.size(), 2u);
  EXPECT_FALSE(fs::exists(data_ / "b"));
}

TEST_F(DatasetUpdate, WhereNoLogCanBeReadNothingIsMade) {
  write_bytes(log("a"), "no bag");
  EXPECT_THAT(error_of({log("a")}), HasSubstr("a.bag"));
  EXPECT_FALSE(fs::exists(data_));
  EXPECT_FALSE(fs::exists(folder_.path() / "data.partial"));
}

TEST_F(DatasetUpdate, ABuildThatWasKilledGoesOnWhereItWas) {
  const pid_t child = test::start_copy([&] {
    BuildOptions options;
    options.at_once = 1;
    options.progress = [](std::int64_t done, std::int64_t total) {
      if (done > total / 2) raise(SIGKILL);
    };
    build_dataset(config_, small_rig(), {log("a"), log("b"), log("c")}, data_, options);
    return 0;
  });
  const ChildState end = wait_for_child(child);
  ASSERT_TRUE(end.status && WIFSIGNALED(*end.status));
  ASSERT_TRUE(fs::exists(folder_.path() / "data.partial" / "a" / "build.yaml"));
  const BuildResult result = build({log("a"), log("b"), log("c")});
  EXPECT_THAT(result.kept, ::testing::Contains("a"));
  EXPECT_THAT(result.built, ::testing::Contains("c"));
  build({log("a"), log("b"), log("c")}, folder_.path() / "at_once");
  EXPECT_EQ(read_tree(data_), read_tree(folder_.path() / "at_once"));
}

TEST_F(DatasetUpdate, TwoBuildsOfOneFolderAtATimeAreRefused) {
  BuildOptions options;
  std::string second;
  options.progress = [&](std::int64_t, std::int64_t) {
    if (second.empty()) second = error_of({log("b")});
  };
  build_dataset(config_, small_rig(), {log("a")}, data_, options);
  EXPECT_THAT(second, HasSubstr("another alight-dataset builds it"));
}

TEST_F(DatasetUpdate, TheNumberOfProcessesChangesNothing) {
  for (const int at_once : {1, 3}) {
    BuildOptions options;
    options.at_once = at_once;
    build_dataset(config_, small_rig(), {log("a"), log("b"), log("c")},
                  folder_.path() / std::to_string(at_once), options);
  }
  EXPECT_EQ(read_tree(folder_.path() / "1"), read_tree(folder_.path() / "3"));
}

TEST_F(DatasetUpdate, MergedPartsEqualOneBuild) {
  build({log("a"), log("c")}, folder_.path() / "part_1");
  build({log("b")}, folder_.path() / "part_2");
  merge_datasets({folder_.path() / "part_1", folder_.path() / "part_2"}, folder_.path() / "merged");
  build({log("a"), log("c"), log("b")});
  EXPECT_EQ(read_tree(folder_.path() / "merged"), read_tree(data_));
  EXPECT_THAT(build({log("a"), log("b"), log("c")}, folder_.path() / "merged").built, IsEmpty());
}

TEST_F(DatasetUpdate, PartsThatDoNotBelongTogetherAreNotMerged) {
  build({log("a")}, folder_.path() / "part_1");
  build({log("a")}, folder_.path() / "same");
  config_.depth_map.window_after_s = 0.5;
  build({log("b")}, folder_.path() / "other");
  const auto error = [&](const std::string& other) {
    return message_of<DataError>(
        [&] { merge_datasets({folder_.path() / "part_1", folder_.path() / other}, data_); });
  };
  EXPECT_THAT(error("same"), AllOf(HasSubstr("flight a"), HasSubstr("part_1")));
  EXPECT_THAT(error("other"), HasSubstr("another configuration"));
  EXPECT_THAT(error("nowhere"), HasSubstr("is no data set"));
  EXPECT_FALSE(fs::exists(data_));
}

}  // namespace
}  // namespace alight::testing
