#include "infer/recorder/segment_log.hpp"

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "foundation/processes/child_exit.hpp"
#include "tests/support/file_text.hpp"
#include "tests/support/programs.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;

class SegmentLog : public ::testing::Test {
 protected:
  static Record record(int i, std::size_t size = 100) {
    return {RecordKind::kFrame, i, std::string(size, static_cast<char>('a' + i % 26))};
  }
  void write(int count, const SegmentLogLimits& limits = {}) const {
    SegmentWriter writer(folder_, limits, {RecordKind::kSettings, 0, "settings"});
    for (int i = 0; i < count; ++i) EXPECT_TRUE(writer.append(record(i))) << writer.error();
  }
  fs::path segment(int number) const {
    char name[16];
    std::snprintf(name, sizeof name, "%08d.rec", number);
    return folder_ / name;
  }
  static std::vector<int> times(const SegmentLogContents& contents) {
    std::vector<int> times;
    for (const Record& record : contents.records) {
      if (record.kind == RecordKind::kFrame) times.push_back(static_cast<int>(record.t_ns));
    }
    return times;
  }
  static std::vector<int> range(int begin, int end) {
    std::vector<int> numbers;
    for (int i = begin; i < end; ++i) numbers.push_back(i);
    return numbers;
  }

  const test::ScratchFolder scratch_;
  const fs::path folder_ = scratch_ / "record";
};

TEST_F(SegmentLog, RecordsComeBackAsTheyWere) {
  write(10);
  const SegmentLogContents contents = read_segments(folder_);
  EXPECT_TRUE(contents.damages.empty());
  EXPECT_EQ(times(contents), range(0, 10));
  EXPECT_EQ(contents.records.front().content, "settings");
  EXPECT_EQ(contents.records.at(3).content, record(2).content);
}

TEST_F(SegmentLog, ATornTailLosesTheLastRecordAlone) {
  write(10);
  fs::resize_file(segment(1), fs::file_size(segment(1)) - 7);
  const SegmentLogContents contents = read_segments(folder_);
  EXPECT_EQ(times(contents), range(0, 9));
  ASSERT_EQ(contents.damages.size(), 1U);
  EXPECT_NE(contents.damages.front().find("torn end"), std::string::npos);
}

/// Wherever a byte flips, in magic, length, checksum or content, the records around it are read.
TEST_F(SegmentLog, AFlippedByteLosesItsRecordAndIsNamed) {
  write(3);
  const std::string whole = test::file_text(segment(1));
  const std::size_t size = 12 + 9 + 100;
  const std::size_t second = whole.size() - 2 * size;
  for (std::size_t at = second; at < second + size; ++at) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
    std::ofstream(segment(1), std::ios::binary) << flipped;
    const SegmentLogContents contents = read_segments(folder_);
    ASSERT_EQ(times(contents), (std::vector<int>{0, 2})) << at - second;
    ASSERT_EQ(contents.damages.size(), 1U);
    EXPECT_NE(contents.damages.front().find(std::to_string(size) + " bytes at " + std::to_string(second)),
              std::string::npos)
        << contents.damages.front();
  }
}

TEST_F(SegmentLog, AKilledWriterLeavesEveryRecordThatWasAppended) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t child = test::start_copy([&] {
    SegmentWriter writer(folder_, {}, {RecordKind::kSettings, 0, "settings"});
    int i = 0;
    while (writer.append(record(i)) && ::write(pipe_ends[1], &i, sizeof i) == sizeof i) ++i;
    return 1;
  });
  int appended = 0;
  while (appended < 200)
    ASSERT_EQ(::read(pipe_ends[0], &appended, sizeof appended), static_cast<ssize_t>(sizeof appended));
  kill(child, SIGKILL);
  wait_for_child(child);
  close(pipe_ends[1]);
  for (int later = 0; ::read(pipe_ends[0], &later, sizeof later) == static_cast<ssize_t>(sizeof later);)
    appended = later;
  close(pipe_ends[0]);
  const std::vector<int> found = times(read_segments(folder_));
  ASSERT_GE(found.size(), static_cast<std::size_t>(appended + 1));
  EXPECT_EQ(found, range(0, static_cast<int>(found.size())));
}

TEST_F(SegmentLog, TheNextWriterGoesOnInAFileOfItsOwn) {
  write(5);
  fs::resize_file(segment(1), fs::file_size(segment(1)) - 7);
  write(2);
  EXPECT_TRUE(fs::exists(segment(2)));
  EXPECT_EQ(times(read_segments(folder_)), (std::vector<int>{0, 1, 2, 3, 0, 1}));
}

TEST_F(SegmentLog, TheOldestFilesGoAndEveryFileBeginsWithTheSettings) {
  const SegmentLogLimits limits{1000, 5000};
  write(1000, limits);
  std::uintmax_t total = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) total += entry.file_size();
  EXPECT_LE(total, 5000U);
  EXPECT_GT(total, 3000U);
  const SegmentLogContents contents = read_segments(folder_);
  EXPECT_TRUE(contents.damages.empty());
  EXPECT_EQ(contents.records.front().kind, RecordKind::kSettings);
  const std::vector<int> found = times(contents);
  EXPECT_EQ(found, range(1000 - static_cast<int>(found.size()), 1000));
}

/// The kernel cuts a write short and refuses the next, as a full disk does.
TEST_F(SegmentLog, AFullDiskIsAnErrorAndWhatWasWrittenStaysWhole) {
  const pid_t child = test::start_copy([&] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2000, 2000};
    setrlimit(RLIMIT_FSIZE, &limit);
    SegmentWriter writer(folder_, {}, {RecordKind::kSettings, 0, "settings"});
    int failed = 0;
    for (int i = 0; i < 100; ++i) failed += writer.append(record(i)) ? 0 : 1;
    return failed > 50 && !writer.error().empty() ? 0 : 1;
  });
  EXPECT_TRUE(wait_for_child(child).succeeded());
  const SegmentLogContents contents = read_segments(folder_);
  EXPECT_TRUE(contents.damages.empty());
  EXPECT_EQ(times(contents), range(0, 16));
}

TEST_F(SegmentLog, NoRecordIsAnError) {
  EXPECT_THROW(read_segments(folder_), DataError);
  fs::create_directories(folder_);
  EXPECT_THROW(read_segments(folder_), DataError);
}

}  // namespace
}  // namespace alight
