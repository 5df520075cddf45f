#include <gtest/gtest.h>

#include "host/auth/ResumeTokens.h"

namespace naiad {
namespace {

class ResumeTokensTest : public testing::Test {
 protected:
  ResumeTokens tokens;
  const std::string first = tokens.issue(5);  ///< the first token of session 5
};

TEST_F(ResumeTokensTest, NameTheSessionTheyWereIssuedFor) {
  tokens.issue(6);
  EXPECT_EQ(first.size(), ResumeTokens::kBytes);
  EXPECT_EQ(tokens.redeem(first), 5u);
  EXPECT_EQ(tokens.redeem(std::string(ResumeTokens::kBytes, 'x')), std::nullopt);
  EXPECT_EQ(tokens.redeem(""), std::nullopt);
}

TEST_F(ResumeTokensTest, HolderLookupAcceptsOnlyNewestAndConsumesNothing) {
  for (int i = 0; i < 3; ++i) EXPECT_EQ(tokens.findNewest(first), 5u);
  EXPECT_EQ(tokens.redeem(first), 5u);
  const std::string second = tokens.issue(5);
  EXPECT_EQ(tokens.findNewest(first), std::nullopt) << "though it could be redeemed again";
  EXPECT_EQ(tokens.findNewest(second), 5u);
  EXPECT_EQ(tokens.redeem(first), 5u);
  EXPECT_EQ(tokens.findNewest(""), std::nullopt);
}

TEST_F(ResumeTokensTest, RemainValidUntilTheNextIsConfirmed) {
  ASSERT_EQ(tokens.redeem(first), 5u);
  const std::string lost = tokens.issue(5);
  ASSERT_EQ(tokens.redeem(first), 5u) << "the answer with the second may be lost";
  const std::string third = tokens.issue(5);
  EXPECT_EQ(tokens.redeem(lost), std::nullopt) << "an answer that was not the last";
  tokens.confirm(5);
  EXPECT_EQ(tokens.redeem(first), std::nullopt);
  EXPECT_EQ(tokens.redeem(third), 5u);
}

TEST_F(ResumeTokensTest, ExpireOnLaterTokenUseAndOnSessionEnd) {
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
TEST_F(ResumeTokensTest, StayValidAfterRestoringTheirHashes) {
  ASSERT_EQ(tokens.redeem(first), 5u);
  const std::string second = tokens.issue(5);
  const std::string other = tokens.issue(6);
  ResumeTokens restored;
  restored.restore(1, tokens.hashed(5));
  EXPECT_EQ(restored.find(first), 1u) << "the answer with the second may be lost";
  EXPECT_EQ(restored.find(second), 1u);
  EXPECT_EQ(restored.findNewest(second), 1u);
  EXPECT_EQ(restored.find(other), std::nullopt);
  restored.confirm(1);
  EXPECT_EQ(restored.find(first), std::nullopt);
}

TEST_F(ResumeTokensTest, RemainValidAfterMovingToAnotherSession) {
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

TEST_F(ResumeTokensTest, ReportSessionsResumedElsewhere) {
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

TEST_F(ResumeTokensTest, ClientRestartMayBeRetriedAfterALostAnswer) {
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
