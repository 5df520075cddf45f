// Looking up players by name, and votes on them, without a server.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "host/admin/VoteKick.h"
#include "host/ops/AdminConsole.h"

namespace naiad {
namespace {

struct Players {
  std::vector<AdminPlayer> all;

  AdminPlayer& add(const std::string& name, const std::string& address = "192.0.2.1:50000") {
    const auto number = static_cast<std::uint32_t>(all.size()) + 1;
    all.push_back({.session = 100 + number, .id = number, .name = name, .address = address, .room = {}});
    return all.back();
  }
};

std::uint32_t chosen(const Players& target, const std::string& typed) {
  const PlayerLookup choice = resolvePlayer(target.all, typed);
  return choice.player ? choice.player->id : 0;
}

TEST(PlayerLookup, ExactNameWinsOverPrefix) {
  Players target;
  target.add("Anna");
  target.add("Ann");
  EXPECT_EQ(chosen(target, "Ann"), 2u);
  EXPECT_EQ(chosen(target, "ann"), 2u);
  EXPECT_EQ(chosen(target, "anna"), 1u);
}

TEST(PlayerLookup, AmbiguousPrefixIsAnErrorListingCandidates) {
  Players target;
  target.add("Anna");
  target.add("Annika");
  target.add("Bob");
  const PlayerLookup choice = resolvePlayer(target.all, "an");
  EXPECT_FALSE(choice.player);
  EXPECT_FALSE(choice.problem.ok);
  EXPECT_EQ(choice.problem.candidates, (std::vector<std::string>{"#1 Anna", "#2 Annika"}));
  EXPECT_EQ(chosen(target, "b"), 3u);
}

TEST(PlayerLookup, HashNumberMatchesIdsNotNames) {
  Players target;
  target.add("#2");
  target.add("Bob");
  EXPECT_EQ(chosen(target, "#2"), 2u);
  EXPECT_EQ(chosen(target, "#1"), 1u);
  EXPECT_EQ(chosen(target, "#3"), 0u);
}

TEST(PlayerLookup, UnknownNameMatchesNoPlayer) {
  Players target;
  const PlayerLookup choice = resolvePlayer(target.all, "Ann");
  EXPECT_FALSE(choice.player);
  EXPECT_EQ(choice.problem.text, "There is no player \"Ann\".");
}

using Outcome = VoteKick::Outcome;

class VoteKickTest : public testing::Test {
 protected:
  /// Adds players, each at its own address.
  void addPlayers(int count) {
    for (int i = 0; i < count; ++i)
      target.add("p" + std::to_string(i), "192.0.2." + std::to_string(i + 1) + ":1");
  }
  Outcome vote(std::size_t voter, std::size_t on) {
    return votes.vote(target.all, target.all[voter].session, target.all[on].session, now);
  }

  Players target;
  VoteKick votes;
  VoteKick::Time now = VoteKick::Time() + std::chrono::hours(1);
};

TEST_F(VoteKickTest, VotePassesWithMoreThanHalf) {
  addPlayers(4);
  EXPECT_EQ(vote(0, 3), Outcome::kBegun);
  EXPECT_EQ(vote(0, 3), Outcome::kAlready);
  EXPECT_EQ(vote(1, 3), Outcome::kAgreed);
  EXPECT_EQ(vote(2, 3), Outcome::kPassed);
}

TEST_F(VoteKickTest, SingleVoteDoesNotKick) {
  addPlayers(2);
  EXPECT_EQ(vote(0, 1), Outcome::kBegun);
  EXPECT_EQ(votes.needed(), 2u);
}

TEST_F(VoteKickTest, AddressHasOneVoteForAllItsPlayers) {
  addPlayers(3);
  for (int i = 0; i < 10; ++i) target.add("q" + std::to_string(i), "192.0.2.1:" + std::to_string(100 + i));
  EXPECT_EQ(vote(0, 2), Outcome::kBegun);
  for (std::size_t i = 3; i < 13; ++i) EXPECT_EQ(vote(i, 2), Outcome::kAlready);
  EXPECT_EQ(votes.needed(), 2u) << "of three addresses";
  EXPECT_EQ(vote(1, 2), Outcome::kPassed);
}

TEST_F(VoteKickTest, PlayersCannotVoteOnTheirOwnAddress) {
  addPlayers(2);
  target.add("neighbour", "192.0.2.1:77");
  EXPECT_EQ(vote(0, 0), Outcome::kSelf);
  EXPECT_EQ(vote(0, 2), Outcome::kSelf);
}

TEST_F(VoteKickTest, OnlyOneVoteRunsAndItTimesOut) {
  addPlayers(5);
  EXPECT_EQ(vote(0, 4), Outcome::kBegun);
  EXPECT_EQ(vote(1, 3), Outcome::kOther);
  EXPECT_FALSE(votes.popFailed(now));
  now += VoteKick::kTime;
  EXPECT_EQ(votes.popFailed(now), std::optional(target.all[4].session));
  EXPECT_FALSE(votes.popFailed(now)) << "once";
  EXPECT_EQ(vote(1, 4), Outcome::kBegun) << "the voices of before are gone";
}

TEST_F(VoteKickTest, VoterStartsOneVoteInTwoMinutes) {
  addPlayers(4);
  EXPECT_EQ(vote(0, 3), Outcome::kBegun);
  now += VoteKick::kTime;
  EXPECT_EQ(vote(0, 2), Outcome::kTooSoon);
  now += VoteKick::kMinInterval;
  EXPECT_EQ(vote(0, 2), Outcome::kBegun);
}

TEST_F(VoteKickTest, VotesOfDisconnectedPlayersDoNotCount) {
  addPlayers(5);
  EXPECT_EQ(vote(0, 4), Outcome::kBegun);
  EXPECT_EQ(vote(1, 4), Outcome::kAgreed);
  target.all[0].detached = true;
  EXPECT_EQ(vote(2, 4), Outcome::kAgreed);
  EXPECT_EQ(votes.votes(), 2u);
}

}  // namespace
}  // namespace naiad
