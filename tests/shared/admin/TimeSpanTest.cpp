#include <gtest/gtest.h>

#include "shared/admin/TimeSpan.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

TEST(TimeSpan, ReadsNumbersWithUnits) {
  EXPECT_EQ(readTimeSpan("90s"), std::optional(90s));
  EXPECT_EQ(readTimeSpan("30m"), std::optional<std::chrono::seconds>(30min));
  EXPECT_EQ(readTimeSpan("2h"), std::optional<std::chrono::seconds>(2h));
  EXPECT_EQ(readTimeSpan("7d"), std::optional<std::chrono::seconds>(168h));
  EXPECT_EQ(readTimeSpan("1w"), readTimeSpan("7d"));
}

TEST(TimeSpan, RefusesInvalidSpans) {
  for (const char* text : {"", "m", "30", "-1m", "0m", "1.5h", "30 m", "30mm", "m30", "99999999999999999999s",
                           "9223372036854775807w", "4000d", "+3m"})
    EXPECT_FALSE(readTimeSpan(text)) << text;
  EXPECT_EQ(readTimeSpan("3653d"), std::optional(kMaxTimeSpan));
}

TEST(TimeSpan, IsWrittenInTheLargestWholeUnit) {
  EXPECT_EQ(timeSpanText(90s), "90s");
  EXPECT_EQ(timeSpanText(30min), "30m");
  EXPECT_EQ(timeSpanText(48h), "2d");
  EXPECT_EQ(timeSpanText(-5s), "0s");
  EXPECT_EQ(timeText(std::chrono::system_clock::time_point(86'400s)), "1970-01-02 00:00 UTC");
}

}  // namespace
}  // namespace naiad
