#include <gtest/gtest.h>

#include "Players.h"
#include "host/ops/AdminConsole.h"

namespace naiad {
namespace {

std::uint32_t chosen(const test::Players& target, const std::string& typed) {
  const PlayerLookup choice = resolvePlayer(target.all, typed);
  return choice.player ? choice.player->id : 0;
}

TEST(PlayerLookup, ExactNameWinsOverPrefix) {
  test::Players target;
  target.add("Anna");
  target.add("Ann");
  EXPECT_EQ(chosen(target, "Ann"), 2u);
  EXPECT_EQ(chosen(target, "ann"), 2u);
  EXPECT_EQ(chosen(target, "anna"), 1u);
}

TEST(PlayerLookup, AmbiguousPrefixIsAnErrorListingCandidates) {
  test::Players target;
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
  test::Players target;
  target.add("#2");
  target.add("Bob");
  EXPECT_EQ(chosen(target, "#2"), 2u);
  EXPECT_EQ(chosen(target, "#1"), 1u);
  EXPECT_EQ(chosen(target, "#3"), 0u);
}

TEST(PlayerLookup, UnknownNameMatchesNoPlayer) {
  test::Players target;
  const PlayerLookup choice = resolvePlayer(target.all, "Ann");
  EXPECT_FALSE(choice.player);
  EXPECT_EQ(choice.problem.text, "There is no player \"Ann\".");
}

}  // namespace
}  // namespace naiad
