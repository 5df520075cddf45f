#include <gtest/gtest.h>

#include <set>
#include <string>

#include "ResumeTokens.h"

namespace naiad {
namespace {

TEST(ResumeTokens, LeadToTheirSessionOnce) {
  ResumeTokens tokens;
  const std::string first = tokens.issue(1);
  const std::string second = tokens.issue(2);
  EXPECT_EQ(first.size(), ResumeTokens::kBytes);
  EXPECT_EQ(tokens.redeem(second), 2u);
  EXPECT_EQ(tokens.redeem(second), std::nullopt);
  EXPECT_EQ(tokens.redeem(first), 1u);
  EXPECT_EQ(tokens.redeem(first), std::nullopt);
}

TEST(ResumeTokens, ANewOneVoidsTheOneBefore) {
  ResumeTokens tokens;
  const std::string before = tokens.issue(1);
  const std::string now = tokens.issue(1);
  EXPECT_NE(before, now);
  EXPECT_EQ(tokens.redeem(before), std::nullopt);
  EXPECT_EQ(tokens.redeem(now), 1u);
}

TEST(ResumeTokens, AForgottenSessionHasNone) {
  ResumeTokens tokens;
  const std::string token = tokens.issue(1);
  const std::string other = tokens.issue(2);
  tokens.forget(1);
  tokens.forget(1);
  tokens.forget(3);
  EXPECT_EQ(tokens.redeem(token), std::nullopt);
  EXPECT_EQ(tokens.redeem(other), 2u);
}

TEST(ResumeTokens, WhatIsNoneLeadsNowhere) {
  ResumeTokens tokens;
  std::string token = tokens.issue(1);
  EXPECT_EQ(tokens.redeem(""), std::nullopt);
  EXPECT_EQ(tokens.redeem(std::string(16, '\0')), std::nullopt);
  EXPECT_EQ(tokens.redeem(token + '\0'), std::nullopt);
  EXPECT_EQ(tokens.redeem(token.substr(1)), std::nullopt);
  token[7] ^= 1;
  EXPECT_EQ(tokens.redeem(token), std::nullopt);
  token[7] ^= 1;
  EXPECT_EQ(tokens.redeem(token), 1u) << "failed guesses cost nobody his place";
}

TEST(ResumeTokens, AreAllDifferent) {
  ResumeTokens tokens;
  std::set<std::string> seen;
  for (std::uint64_t session = 0; session < 1000; ++session) seen.insert(tokens.issue(session));
  EXPECT_EQ(seen.size(), 1000u);
}

}  // namespace
}  // namespace naiad
