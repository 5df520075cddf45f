#include <gtest/gtest.h>

#include "host/auth/ResumeTokens.h"

namespace naiad {
namespace {

TEST(ResumeTokens, NameTheSessionTheyWereIssuedFor) {
  ResumeTokens tokens;
  const std::string token = tokens.issue(5);
  tokens.issue(6);
  EXPECT_EQ(token.size(), ResumeTokens::kBytes);
  EXPECT_EQ(tokens.redeem(token), 5u);
  EXPECT_EQ(tokens.redeem(std::string(ResumeTokens::kBytes, 'x')), std::nullopt);
  EXPECT_EQ(tokens.redeem(""), std::nullopt);
}

TEST(ResumeTokens, HolderLookupAcceptsOnlyNewestAndConsumesNothing) {
  ResumeTokens tokens;
  const std::string first = tokens.issue(5);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(tokens.findNewest(first), 5u);
  EXPECT_EQ(tokens.redeem(first), 5u);
  const std::string second = tokens.issue(5);
  EXPECT_EQ(tokens.findNewest(first), std::nullopt) << "though it could be redeemed again";
  EXPECT_EQ(tokens.findNewest(second), 5u);
  EXPECT_EQ(tokens.redeem(first), 5u);
  EXPECT_EQ(tokens.findNewest(""), std::nullopt);
}

TEST(ResumeTokens, RemainValidUntilTheNextIsConfirmed) {
  ResumeTokens tokens;
  const std::string first = tokens.issue(5);
  ASSERT_EQ(tokens.redeem(first), 5u);
  const std::string lost = tokens.issue(5);
  ASSERT_EQ(tokens.redeem(first), 5u) << "the answer with the second may be lost";
  const std::string third = tokens.issue(5);
  EXPECT_EQ(tokens.redeem(lost), std::nullopt) << "an answer that was not the last";
  tokens.confirm(5);
  EXPECT_EQ(tokens.redeem(first), std::nullopt);
  EXPECT_EQ(tokens.redeem(third), 5u);
}

TEST(ResumeTokens, ExpireOnLaterTokenUseAndOnSessionEnd) {
  ResumeTokens tokens;
  const std::string first = tokens.issue(5);
  ASSERT_EQ(tokens.redeem(first), 5u);
  const std::string second = tokens.issue(5);
  ASSERT_EQ(tokens.redeem(second), 5u);
  EXPECT_EQ(tokens.redeem(first), std::nullopt);
  const std::string third = tokens.issue(5);
  tokens.forget(5);
  EXPECT_EQ(tokens.redeem(second), std::nullopt);
  EXPECT_EQ(tokens.redeem(third), std::nullopt);
}

// The restored server knows only the stored hashes of the tokens.
TEST(ResumeTokens, StayValidAfterRestoringTheirHashes) {
  ResumeTokens killed;
  const std::string first = killed.issue(5);
  ASSERT_EQ(killed.redeem(first), 5u);
  const std::string second = killed.issue(5);
  const std::string other = killed.issue(6);
  ResumeTokens tokens;
  tokens.restore(1, killed.hashed(5));
  EXPECT_EQ(tokens.find(first), 1u) << "the answer with the second may be lost";
  EXPECT_EQ(tokens.find(second), 1u);
  EXPECT_EQ(tokens.findNewest(second), 1u);
  EXPECT_EQ(tokens.find(other), std::nullopt);
  tokens.confirm(1);
  EXPECT_EQ(tokens.find(first), std::nullopt);
}

TEST(ResumeTokens, RemainValidAfterMovingToAnotherSession) {
  ResumeTokens tokens;
  const std::string first = tokens.issue(5);
  ASSERT_EQ(tokens.redeem(first), 5u);
  tokens.move(5, 9);
  const std::string second = tokens.issue(9);
  EXPECT_EQ(tokens.find(first), 9u);
  EXPECT_EQ(tokens.find(second), 9u);
  tokens.forget(5);
  EXPECT_EQ(tokens.find(first), 9u) << "the one before is no more";
  tokens.confirm(9);
  EXPECT_EQ(tokens.find(first), std::nullopt);
  EXPECT_EQ(tokens.find(second), 9u);
}

TEST(ResumeTokens, ReportSessionsResumedElsewhere) {
  ResumeTokens tokens;
  const std::string first = tokens.issue(5);
  ASSERT_EQ(tokens.redeem(first), 5u);
  tokens.markSuperseded(5);
  const std::string second = tokens.issue(5);
  EXPECT_FALSE(tokens.isSuperseded(first)) << "the other process may not have got its answer";
  tokens.confirm(5);
  EXPECT_TRUE(tokens.isSuperseded(first));
  EXPECT_FALSE(tokens.isSuperseded(second));
  EXPECT_EQ(tokens.redeem(first), std::nullopt);
  // An ordinary resume does not supersede the old token.
  ASSERT_EQ(tokens.redeem(second), 5u);
  const std::string third = tokens.issue(5);
  tokens.confirm(5);
  EXPECT_FALSE(tokens.isSuperseded(second));
  EXPECT_TRUE(tokens.isSuperseded(first));
  ASSERT_EQ(tokens.redeem(third), 5u);
  tokens.forget(5);
  EXPECT_FALSE(tokens.isSuperseded(first));
}

TEST(ResumeTokens, ClientRestartMayBeRetriedAfterALostAnswer) {
  ResumeTokens tokens;
  const std::string first = tokens.issue(5);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(tokens.redeem(first), 5u);
    tokens.markSuperseded(5);
    tokens.issue(5);
  }
  const std::string last = tokens.issue(5);
  ASSERT_EQ(tokens.redeem(last), 5u) << "the other process comes back with its own";
  EXPECT_TRUE(tokens.isSuperseded(first));
}

}  // namespace
}  // namespace naiad
