#include "Compare.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace naiad::test {

namespace {

std::string describe(std::uint32_t tick, const df::Canvas& seen, const df::Canvas& truth) {
  std::string text = "tick " + std::to_string(tick) + ", wrong cells:";
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      if (seen.at(x, y) == truth.at(x, y)) continue;
      text += " (" + std::to_string(x) + "," + std::to_string(y) + ") seen '";
      df::appendUtf8(text, seen.at(x, y).ch);
      text += "' colour " + std::to_string(seen.at(x, y).color) + ", true '";
      df::appendUtf8(text, truth.at(x, y).ch);
      text += "' colour " + std::to_string(truth.at(x, y).color) + ";";
    }
  }
  return text + "\nseen:\n" + seen.text() + "true:\n" + truth.text();
}

}  // namespace

bool showsTheTruth(TestClient& client, const TestServer& server) {
  if (client.pictures().empty()) return false;
  const auto& [tick, picture] = *client.pictures().rbegin();
  const auto truth = server.truth(tick, client.player());
  return truth && countDifferences(picture, *truth) == 0;
}

void expectSame(TestClient& client, TestServer& server, int least_ticks) {
  int ticks = 0;
  int wrong = 0;
  std::uint64_t wrong_ticks = 0;
  std::string first_difference;
  for (const auto& [tick, picture] : client.pictures()) {
    const auto truth = server.truth(tick, client.player());
    if (!truth) continue;
    ++ticks;
    const int differences = countDifferences(picture, *truth);
    if (differences == 0) continue;
    if (wrong == 0) first_difference = describe(tick, picture, *truth);
    wrong += differences;
    ++wrong_ticks;
  }
  EXPECT_GE(ticks, least_ticks);
  const std::uint64_t skipped = server.skippedTicks(client.player());
  EXPECT_LE(wrong_ticks, skipped) << first_difference;
  std::printf("compared ticks=%d wrong=%d skipped=%d\n", ticks, wrong, static_cast<int>(skipped));
}

}  // namespace naiad::test
