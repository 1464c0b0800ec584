#include "infer/health/symptom.hpp"

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

std::int64_t after(double s) { return to_nanoseconds(s); }

TEST(Symptom, OneSignIsNoFinding) {
  Symptom symptom("lidar", "noise");
  symptom.look({}, after(1.0), true, "x");
  EXPECT_TRUE(symptom.suspected());
  symptom.look({}, after(1.1), false, "");
  symptom.look({}, after(1.2), true, "x");
  EXPECT_FALSE(symptom.present());
}

TEST(Symptom, SignsThatFollowOneAnotherAreAFindingSinceTheFirst) {
  Symptom symptom("lidar", "noise");
  symptom.look({}, after(1.0), true, "a");
  symptom.look({}, after(1.1), true, "b");
  ASSERT_TRUE(symptom.present());
  EXPECT_EQ(symptom.finding().since_ns, after(1.0));
  EXPECT_EQ(symptom.finding().reason, "b");
}

TEST(Symptom, EndsASecondAfterTheLastSign) {
  Symptom symptom("lidar", "noise");
  symptom.raise(after(1.0), "a");
  symptom.look({}, after(1.9), false, "");
  EXPECT_TRUE(symptom.present());
  symptom.look({}, after(2.0), false, "");
  EXPECT_FALSE(symptom.present());
}

}  // namespace
}  // namespace alight
