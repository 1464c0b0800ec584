#include "train/evaluation/table.hpp"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/file_text.hpp"
#include "tests/support/scratch_folder.hpp"
#include "train/evaluation/table_markdown.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

PixelErrors one_pixel(double predicted_m, double truth_m) {
  PixelErrors errors;
  errors.add(predicted_m, truth_m);
  return errors;
}

/// One method, P=0 and 0.5 s; at P=0 flight a errs by 1 m of 10 and b by 3 m of 10, both substituted; at 0.5 s a by 2 m.
EvaluationReport small_report() {
  EvaluationReport report;
  report.about = {{"data set", "data/demo"}};
  report.methods = {"say \"net\""};
  report.feedings = make_feedings({0}, {0.5});
  report.cells.assign(1, std::vector<EvaluationCell>(2));
  PixelErrors a, b;
  a.add_substituted(11, 10);
  b.add_substituted(13, 10);
  b.add_unknown();
  report.cells[0][0].regions[0].add("a", a);
  report.cells[0][0].regions[0].add("b", b);
  report.cells[0][1].regions[0].add("a", one_pixel(12, 10));
  report.cells[0][0].similarity.add("a", 0.75);
  report.first_method.resize(5);
  return report;
}

TEST(Table, MarkdownShowsMeanErrorAndSubstitution) {
  const std::string text = to_markdown(small_report());
  EXPECT_THAT(text, HasSubstr("- data set: data/demo\n- samples: 5\n"));
  EXPECT_THAT(text, HasSubstr("## all\n\nLiDAR pixels of the full window.\n"));
  EXPECT_THAT(text, HasSubstr("| RMSE [mm] | P=0 | 0.5 s |\n|---|---:|---:|\n"));
  EXPECT_THAT(text, HasSubstr("| say \"net\" | 2000.0 ± 1000.0 * | 2000.0 |\n"));
  EXPECT_THAT(text, HasSubstr("| SSIM | P=0 |\n"));
  EXPECT_THAT(text, HasSubstr("| say \"net\" | 0.7500 * |\n"));
  EXPECT_THAT(text, Not(HasSubstr("## dense")));  // nothing of it was measured
}

TEST(Table, CsvHasALineAValue) {
  const std::string text = to_csv(small_report());
  EXPECT_THAT(text, HasSubstr("\"say \"\"net\"\"\",\"P=0\",all,mae_mm,2000,2000,1000,2,2,2,1\n"));
  EXPECT_THAT(text, HasSubstr("\"say \"\"net\"\"\",\"0.5 s\",all,rel_x1000,200,200,,1,1,0,0\n"));
  EXPECT_THAT(text, HasSubstr("\"say \"\"net\"\"\",\"P=0\",right_image,ssim,0.75,0.75,,1,,,\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 4 + 4 + 1);
}

TEST(Table, JsonHasEveryFlight) {
  const auto json = nlohmann::json::parse(to_json(small_report()));
  EXPECT_EQ(json["about"]["data set"], "data/demo");
  EXPECT_EQ(json["samples"], 5);
  const auto& all = json["results"][0]["regions"]["all"];
  EXPECT_EQ(all["mae_mm"]["mean"], 2000);
  EXPECT_EQ(all["mae_mm"]["standard_error"], 1000);
  EXPECT_EQ(all["substituted_pixels"], 2);
  EXPECT_EQ(all["by_flight"]["b"]["mae_mm"], 3000);
  EXPECT_EQ(all["by_flight"]["b"]["unknown_pixels"], 1);
  EXPECT_TRUE(json["results"][1]["regions"]["all"]["mae_mm"]["standard_error"].is_null());
  EXPECT_EQ(json["results"][0]["ssim"]["pooled"], 0.75);
}

TEST(Table, TheExtensionChoosesTheFormat) {
  const test::ScratchFolder dir;
  for (const auto& [file, text] : {std::pair{"t.md", to_markdown(small_report())},
                                   {"t.csv", to_csv(small_report())},
                                   {"t.json", to_json(small_report())}}) {
    write_table(small_report(), dir / file);
    EXPECT_EQ(test::file_text(dir / file), text) << file;
  }
  EXPECT_THROW(check_table_path(dir / "t.txt"), ConfigError);
  EXPECT_THROW(check_table_path(dir / "t"), ConfigError);
  EXPECT_THROW(check_table_path(dir / "nowhere" / "t.md"), DataError);
}

}  // namespace
}  // namespace alight
