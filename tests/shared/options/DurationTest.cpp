#include <gtest/gtest.h>

#include "shared/options/Duration.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

TEST(Duration, NumbersHaveAUnitOrGetTheGivenOne) {
  EXPECT_EQ(readTimeSpan("90"), std::optional(90s));
  EXPECT_EQ(readTimeSpan("90s"), std::optional(90s));
  EXPECT_EQ(readTimeSpan("30m"), std::optional<std::chrono::seconds>(30min));
  EXPECT_EQ(readTimeSpan("1.5h"), std::optional<std::chrono::seconds>(90min));
  EXPECT_EQ(readTimeSpan("7d"), std::optional<std::chrono::seconds>(168h));
  EXPECT_EQ(readTimeSpan("1w"), readTimeSpan("7d"));
  EXPECT_EQ(readDuration("33ms", kMicrosecond), std::optional(33'000.0));
  EXPECT_EQ(readDuration("0.3"), readDuration("300ms"));
  EXPECT_EQ(readDuration("2s", kMillisecond), readDuration("2000", kMillisecond));
}

TEST(Duration, RefusesInvalidSpans) {
  for (const char* text : {"", "m", "-1m", "0m", "0.1", "inf", "nan", "30 m", "30mm", "m30", "1e",
                           "99999999999999999999s", "9223372036854775807w", "4000d", "+3m"})
    EXPECT_FALSE(readTimeSpan(text)) << text;
  EXPECT_EQ(readTimeSpan("3653d"), std::optional(kMaxTimeSpan));
}

TEST(Duration, IsWrittenInTheLargestWholeUnit) {
  EXPECT_EQ(timeSpanText(90s), "90s");
  EXPECT_EQ(timeSpanText(30min), "30m");
  EXPECT_EQ(timeSpanText(48h), "2d");
  EXPECT_EQ(timeSpanText(-5s), "0s");
  EXPECT_EQ(timeText(std::chrono::system_clock::time_point(86'400s)), "1970-01-02 00:00 UTC");
}

}  // namespace
}  // namespace naiad
