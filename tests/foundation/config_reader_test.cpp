#include "foundation/config_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

enum class Mode { kFast, kSlow };

struct Inner {
  double max_slope_deg = 10;
  std::vector<int> sizes = {1, 2};
};
void bind(Binder& b, Inner& c) {
  b.field("max_slope_deg", c.max_slope_deg, "steepest ground", between(0, 90));
  b.field("sizes", c.sizes, "sizes", at_least(1));
}

struct Outer {
  int count = 3;
  bool on = true;
  std::string name = "a name: with #signs";
  double tiny = 0.1;
  std::int64_t t_ns = 1234567890123456789;
  Mode mode = Mode::kSlow;
  std::optional<int> crop_px = 352;
  std::vector<std::vector<double>> matrix = {{1, 0.5}, {0, 1e-9}};
  std::vector<std::string> words = {"/a/b", "none", "3"};
  Inner inner;
  std::optional<Inner> maybe;
  std::vector<Inner> list = {Inner{}};
};
void bind(Binder& b, Outer& c) {
  b.field("count", c.count, "how many", at_least(1));
  b.field("on", c.on, "switch");
  b.field("name", c.name, "name");
  b.field("tiny", c.tiny, "a small number", positive());
  b.field("t_ns", c.t_ns, "a time");
  b.choice("mode", c.mode, {{"fast", Mode::kFast}, {"slow", Mode::kSlow}}, "mode");
  b.field("crop_px", c.crop_px, "crop", at_least(1));
  b.field("matrix", c.matrix, "matrix");
  b.field("words", c.words, "words");
  b.section("inner", c.inner, "a section");
  b.section("maybe", c.maybe, "a section that may be absent");
  b.list("list", c.list, "a list of sections");
}

struct Strict {
  int needed = 0;
};
void bind(Binder& b, Strict& c) { b.required("needed", c.needed, "must be given"); }

/// A key that takes a number or a section.
struct Either {
  double value = 0;
  std::optional<Inner> section;
};
void bind(Binder& b, Either& c) {
  if (b.loading() && b.is_section("key")) {
    const std::size_t mistakes = b.mistakes();
    b.section("key", c.section, "as a section");
    if (b.mistakes() != mistakes) c.section.reset();
  } else {
    b.field("key", c.value, "as a number");
  }
}

/// Two ways to do one thing, each with keys of its own.
struct Drive {
  Mode mode = Mode::kSlow;
  Inner fast;
  Inner slow;
};
void bind(Binder& b, Drive& c) {
  b.choice("mode", c.mode, {{"fast", Mode::kFast}, {"slow", Mode::kSlow}}, "how");
  b.section_of("mode", "fast", c.fast, "keys of fast");
  b.section_of("mode", "slow", c.slow, "keys of slow");
}
struct Vehicle {
  Drive drive;
};
void bind(Binder& b, Vehicle& c) { b.section("drive", c.drive, "what moves it"); }

template <class T>
std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_config<T>(text, "file.yaml", overrides);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(ConfigReader, AbsentKeysKeepTheirDefaults) {
  const Outer c = parse_config<Outer>("", "empty.yaml");
  EXPECT_EQ(c.count, 3);
  EXPECT_EQ(c.inner.max_slope_deg, 10);
  EXPECT_FALSE(c.maybe.has_value());
}

TEST(ConfigReader, ReadsEveryType) {
  const Outer c = parse_config<Outer>(
      "count: 5\non: false\nname: \"x: y\"\ntiny: 2.5e-3\nt_ns: 9007199254740993\nmode: fast\ncrop_px: none\n"
      "matrix: [[1, 2], [3, 4]]\nwords: [a, b]\ninner: {max_slope_deg: 5, sizes: [7]}\nmaybe: {sizes: [8]}\n"
      "list:\n  - max_slope_deg: 1\n  - sizes: [9, 10]\n",
      "f.yaml");
  EXPECT_EQ(c.count, 5);
  EXPECT_FALSE(c.on);
  EXPECT_EQ(c.name, "x: y");
  EXPECT_EQ(c.tiny, 2.5e-3);
  EXPECT_EQ(c.t_ns, 9007199254740993);  // beyond the integers of a double
  EXPECT_EQ(c.mode, Mode::kFast);
  EXPECT_FALSE(c.crop_px.has_value());
  EXPECT_EQ(c.matrix[1][0], 3);
  EXPECT_EQ(c.words[1], "b");
  EXPECT_EQ(c.inner.sizes, std::vector<int>{7});
  ASSERT_TRUE(c.maybe.has_value());
  EXPECT_EQ(c.maybe->sizes, std::vector<int>{8});
  ASSERT_EQ(c.list.size(), 2U);
  EXPECT_EQ(c.list[1].sizes, (std::vector<int>{9, 10}));
}

TEST(ConfigReader, PrintedConfigReadsBackEqual) {
  Outer c;
  c.maybe = Inner{};
  c.crop_px.reset();
  const std::string printed = print_config(c);
  EXPECT_EQ(print_config(parse_config<Outer>(printed, "printed")), printed);
  EXPECT_THAT(printed, HasSubstr("max_slope_deg: 10  # steepest ground (0 .. 90)"));
  EXPECT_THAT(printed, HasSubstr("mode: slow  # mode (fast | slow)"));
  EXPECT_EQ(parse_config<Outer>(printed, "printed").name, c.name);
  EXPECT_EQ(parse_config<Outer>(printed, "printed").words, c.words);
}

TEST(ConfigReader, EveryMistakeOfAFileIsReportedAtOnceWithItsLine) {
  const std::string message =
      error_of<Outer>("count: 0\nmod: fast\non: maybe\ntiny: -1\ninner:\n  max_slop_deg: 3\n");
  EXPECT_THAT(message, HasSubstr("file.yaml:1: count: expected a whole number (>= 1), got \"0\""));
  EXPECT_THAT(message, HasSubstr("file.yaml:2: mod: no such key; did you mean \"mode\"?"));
  EXPECT_THAT(message, HasSubstr("file.yaml:3: on: expected true or false, got \"maybe\""));
  EXPECT_THAT(message, HasSubstr("file.yaml:4: tiny: expected a number (> 0), got \"-1\""));
  EXPECT_THAT(message,
              HasSubstr("file.yaml:6: inner.max_slop_deg: no such key; did you mean \"max_slope_deg\"?"));
}

TEST(ConfigReader, WrongShapesAreErrors) {
  EXPECT_THAT(error_of<Outer>("count: [1]"), HasSubstr("expected a whole number"));
  EXPECT_THAT(error_of<Outer>("count: 1.5"), HasSubstr("expected a whole number"));
  EXPECT_THAT(error_of<Outer>("count: \"5\""), HasSubstr("expected a whole number"));
  EXPECT_THAT(error_of<Outer>("count: 99999999999"), HasSubstr("expected a whole number"));
  EXPECT_THAT(error_of<Outer>("tiny: .nan"), HasSubstr("expected a number"));
  EXPECT_THAT(error_of<Outer>("inner: 3"), HasSubstr("expected a section"));
  EXPECT_THAT(error_of<Outer>("list: 3"), HasSubstr("expected a list"));
  EXPECT_THAT(error_of<Outer>("list: [3]"), HasSubstr("list.0"));
  EXPECT_THAT(error_of<Outer>("mode: medium"), HasSubstr("expected one of fast | slow"));
  EXPECT_THAT(error_of<Outer>("count: 1\ncount: 2"), HasSubstr("file.yaml:2: count: is given twice"));
  EXPECT_THAT(error_of<Outer>("- 1\n- 2"), HasSubstr("expected keys and values"));
  EXPECT_THAT(error_of<Outer>("a: [1"), HasSubstr("file.yaml:1: not readable as YAML"));
}

TEST(ConfigReader, MissingRequiredKeyIsAnError) {
  EXPECT_THAT(error_of<Strict>(""), HasSubstr("needed: is missing (must be given)"));
  EXPECT_EQ(error_of<Strict>("needed: 1"), "");
}

TEST(ConfigReader, OverridesGoThroughTheSameChecks) {
  const Outer c =
      parse_config<Outer>("inner: {max_slope_deg: 4}\nlist: [{sizes: [1]}]", "f.yaml",
                          {"inner.max_slope_deg=7", "maybe.sizes=[5]", "list.0.sizes=[6]", "crop_px=none"});
  EXPECT_EQ(c.inner.max_slope_deg, 7);
  EXPECT_EQ(c.maybe->sizes, std::vector<int>{5});
  EXPECT_EQ(c.list[0].sizes, std::vector<int>{6});
  EXPECT_THAT(error_of<Outer>("", {"inner.max_slope_deg=100"}),
              HasSubstr("--set inner.max_slope_deg: expected"));
  EXPECT_THAT(error_of<Outer>("", {"inner.nothing=1"}), HasSubstr("--set inner.nothing: no such key"));
  EXPECT_THAT(error_of<Outer>("", {"count"}), HasSubstr("expected a.b=value"));
}

TEST(ConfigReader, MissingFileNamesItself) {
  try {
    load_config<Outer>("/no/such/file.yaml");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr("/no/such/file.yaml: cannot be opened"));
  }
}

TEST(ConfigReader, OneMessagePerKey) {
  const std::string message = error_of<Outer>("count: x");
  EXPECT_THAT(message, Not(HasSubstr("\n")));
}

TEST(ConfigReader, ASectionOfTheChosenNameIsRead) {
  EXPECT_EQ(parse_config<Drive>("slow: {max_slope_deg: 5}", "f").slow.max_slope_deg, 5);
  EXPECT_EQ(parse_config<Drive>("fast: {max_slope_deg: 5}\nmode: fast", "f").fast.max_slope_deg, 5);
  EXPECT_EQ(parse_config<Drive>("", "f", {"fast.max_slope_deg=6", "mode=fast"}).fast.max_slope_deg, 6);
  EXPECT_EQ(error_of<Drive>("slow: {max_slop_deg: 5}"),
            "file.yaml:1: slow.max_slop_deg: no such key; did you mean \"max_slope_deg\"?");
}

TEST(ConfigReader, ASectionOfAnotherNameIsOneMistakeWithItsCure) {
  EXPECT_EQ(
      error_of<Vehicle>("drive:\n  fast:\n    max_slope_deg: 500\n    nonsense: 1\n"),
      "file.yaml:2: drive.fast: belongs to mode: fast, and the mode is slow; remove it or choose that mode");
  EXPECT_EQ(error_of<Vehicle>("drive: {mode: fast}", {"drive.slow.sizes=[1]", "drive.slow.max_slope_deg=3"}),
            "--set drive.slow.max_slope_deg: belongs to mode: slow, and the mode is fast; remove it or "
            "choose that mode");
  EXPECT_THAT(error_of<Vehicle>("drive: {slow: {max_slope_deg: 5}}", {"drive.mode=fast"}),
              HasSubstr("drive.slow: belongs to mode: slow, and the mode is fast"));
  EXPECT_THAT(error_of<Drive>("fast:"), HasSubstr("belongs to mode: fast"));
  EXPECT_THAT(error_of<Drive>("", {"fast=none"}), HasSubstr("--set fast: belongs to mode: fast"));
}

TEST(ConfigReader, AWrongNameOfAChoiceIsNoMistakeOfTheSections) {
  EXPECT_EQ(error_of<Drive>("mode: fats\nfast: {max_slope_deg: 5}"),
            "file.yaml:1: mode: expected one of fast | slow, got \"fats\"");
}

TEST(ConfigReader, OnlyTheSectionOfTheChosenNameIsPrinted) {
  Drive c;
  c.mode = Mode::kFast;
  c.fast.max_slope_deg = 7;
  const std::string printed = print_config(c);
  EXPECT_THAT(printed, Not(HasSubstr("slow:")));
  EXPECT_EQ(parse_config<Drive>(printed, "printed").fast.max_slope_deg, 7);
  EXPECT_EQ(print_config(parse_config<Drive>(printed, "printed")), printed);
}

TEST(ConfigReader, AKeyMayTakeAValueOrASection) {
  EXPECT_EQ(parse_config<Either>("key: 2.5", "f").value, 2.5);
  EXPECT_FALSE(parse_config<Either>("key: 2.5", "f").section.has_value());
  EXPECT_EQ(parse_config<Either>("key: {max_slope_deg: 5}", "f").section->max_slope_deg, 5);
  EXPECT_EQ(parse_config<Either>("{}", "f").value, 0);
  EXPECT_THAT(error_of<Either>("key: {max_slope_deg: 500}"), HasSubstr("key.max_slope_deg"));
  EXPECT_THAT(error_of<Either>("key: [1]"), HasSubstr("expected a number"));
}

}  // namespace
}  // namespace alight
