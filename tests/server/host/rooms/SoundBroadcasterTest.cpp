#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "host/rooms/PlayerListBroadcaster.h"
#include "host/rooms/SoundBroadcaster.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/ReliableFrames.h"

namespace naiad {
namespace {

using Labels = std::vector<std::string>;

class SoundBroadcasterTest : public testing::Test {
 protected:
  void SetUp() override { play(2); }
  void play(std::uint32_t players) {
    view.players.clear();
    for (std::uint32_t id = 1; id <= players; ++id) view.players.emplace_back().id = id;
  }
  void sound(const std::string& label, std::uint32_t player = 0) {
    view.sounds.push_back({label, df::SoundPlayed::kPlay, false, false, player});
  }
  void tick() {
    ++view.tick;
    news.tick(view, receiver(false));
    view.sounds.clear();
  }
  /// Ends the world. Labels start with "-" for a stop and "+" for a sound that plays.
  void changeWorld() { news.changeWorld(receiver(true)); }
  /// Forgets what was sent, and returns a function that takes what is sent.
  SoundBroadcaster::Send receiver(bool with_signs) {
    once.clear();
    lasting.clear();
    return [this, with_signs](std::uint32_t player, const wire::ServerMessage& message, bool lasts) {
      for (const wire::Sound& heard : message.sounds().sounds()) {
        const std::string sign = heard.action() == wire::Sound::STOP ? "-" : "+";
        (lasts ? lasting : once)[player].push_back((with_signs ? sign : "") + heard.label());
      }
      EXPECT_LE(message.sounds().sounds_size(), static_cast<int>(kMaxSounds));
      last = message;
      return sends;
    };
  }

  SoundBroadcaster news;
  df::WorldView view;
  std::map<std::uint32_t, Labels> once, lasting;  ///< labels sent in the last tick
  wire::ServerMessage last;
  bool sends = true;
};

TEST_F(SoundBroadcasterTest, AllPlayersGetASoundInItsTick) {
  tick();
  sound("fire", 2);
  tick();
  EXPECT_EQ(once, (std::map<std::uint32_t, Labels>{{1, {"fire"}}, {2, {"fire"}}}));
  EXPECT_TRUE(lasting.empty());
  EXPECT_EQ(last.sounds().sounds(0).player(), 2u);
  tick();
  EXPECT_TRUE(once.empty());
  EXPECT_EQ(news.sent(), 2u);
  EXPECT_EQ(news.dropped(), 0u);
}

TEST_F(SoundBroadcasterTest, MusicLoopsPausesAndStopsMustArrive) {
  tick();
  view.sounds = {{"theme", df::SoundPlayed::kPlay, true, false, 0},
                 {"siren", df::SoundPlayed::kPlay, false, true, 0},
                 {"fire", df::SoundPlayed::kPlay, false, false, 0},
                 {"fire", df::SoundPlayed::kStop, false, false, 0}};
  tick();
  EXPECT_EQ(lasting[1], (Labels{"theme", "siren", "fire"}));
  EXPECT_EQ(once[1], (Labels{"fire"}));
  view.tick += 100;
  view.sounds = {{"theme", df::SoundPlayed::kPause, true, false, 0}};
  tick();
  EXPECT_EQ(last.sounds().sounds(0).action(), wire::Sound::PAUSE);
  EXPECT_TRUE(last.sounds().sounds(0).music());
}

TEST_F(SoundBroadcasterTest, RepeatedSoundInATickIsSentOnce) {
  for (int i = 0; i < 20; ++i) sound("boom");
  tick();
  EXPECT_EQ(once[1], Labels{"boom"});
  EXPECT_EQ(news.dropped(), 0u);
}

TEST_F(SoundBroadcasterTest, ExcessSoundsOfATickAreDroppedByPriority) {
  tick();
  for (int i = 0; i < 3; ++i) sound("theirs " + std::to_string(i), 2);
  sound("no player's");
  sound("mine", 1);
  view.sounds.push_back({"theme", df::SoundPlayed::kPlay, true, true, 2});
  tick();
  EXPECT_EQ(lasting[1], Labels{"theme"});
  EXPECT_EQ(once[1], (Labels{"theirs 0", "no player's", "mine"})) << "in the order in which they were";
  EXPECT_EQ(once[2], (Labels{"theirs 0", "theirs 1", "theirs 2"}));
  EXPECT_EQ(news.dropped(), 4u);
}

TEST_F(SoundBroadcasterTest, TenSoundsASecondAreSentAndExcessCounted) {
  play(1);
  std::size_t heard = 0;
  for (int i = 0; i < 300; ++i) {
    sound("a");
    sound("b");
    tick();
    heard += once[1].size();
  }
  EXPECT_EQ(heard, SoundBroadcaster::kBurst + 299 / SoundBroadcaster::kTicksPerSound);
  EXPECT_EQ(news.sent(), heard);
  EXPECT_EQ(news.sent() + news.dropped(), 600u);
}

// A player who is disconnected for a minute must not lose the session because of a noisy game.
TEST_F(SoundBroadcasterTest, MinuteOfSoundsFillsUnderHalfTheOutbox) {
  play(1);
  std::size_t bytes = 0;
  for (int i = 0; i < 60 * 30; ++i) {
    std::string label;
    while (label.size() < 3 * kMaxSoundLabel) label += "\u2588";  // three bytes each
    view.sounds.push_back({label, df::SoundPlayed::kPlay, true, i % 2 == 0, 1});
    tick();
    if (!lasting.empty()) bytes += last.SerializeAsString().size() + 10;
  }
  EXPECT_GT(bytes, 10'000u);
  EXPECT_LT(bytes, ReliableFrameSender::kMax / 2);
}

TEST_F(SoundBroadcasterTest, ANewPlayerGetsWhatIsPlaying) {
  const df::SoundPlayed theme{"theme", df::SoundPlayed::kPlay, true, true, 0};
  view.playing = {theme};
  view.sounds = {theme, {"jingle", df::SoundPlayed::kPlay, true, false, 0}};
  tick();
  EXPECT_EQ(lasting[1], (Labels{"theme", "jingle"})) << "once, though it began in this tick";
  play(3);
  tick();
  EXPECT_EQ(lasting, (std::map<std::uint32_t, Labels>{{3, {"theme"}}}));
  news.repeat(2);
  tick();
  EXPECT_EQ(lasting, (std::map<std::uint32_t, Labels>{{2, {"theme"}}}));
  view.players.erase(view.players.begin());
  tick();
  EXPECT_TRUE(lasting.empty());
}

TEST_F(SoundBroadcasterTest, WorldChangeStopsLastingSounds) {
  view.playing = {{"theme", df::SoundPlayed::kPlay, true, true, 0}};
  tick();
  view.playing.push_back({"siren", df::SoundPlayed::kPlay, false, true, 2});
  view.sounds = {{"siren", df::SoundPlayed::kPlay, false, true, 2},
                 {"fire", df::SoundPlayed::kPlay, false, false, 2},
                 {"jingle", df::SoundPlayed::kPlay, true, false, 0},
                 {"storm", df::SoundPlayed::kPlay, false, true, 0}};
  tick();
  view.tick += 100;
  view.sounds = {{"storm", df::SoundPlayed::kStop, false, true, 0},
                 {"theme", df::SoundPlayed::kPause, true, true, 0}};
  tick();
  changeWorld();
  EXPECT_EQ(lasting, (std::map<std::uint32_t, Labels>{{1, {"-siren", "-jingle", "-theme"}},
                                                      {2, {"-siren", "-jingle", "-theme"}}}));
  EXPECT_TRUE(once.empty());
  EXPECT_FALSE(last.sounds().sounds(0).music());
  EXPECT_TRUE(last.sounds().sounds(0).loop());
  EXPECT_EQ(last.sounds().sounds(0).player(), 0u) << "no player caused it";
  EXPECT_TRUE(last.sounds().sounds(1).music());

  changeWorld();
  EXPECT_TRUE(lasting.empty()) << "once";
  view.playing = {{"theme", df::SoundPlayed::kPlay, true, true, 0}};
  tick();
  EXPECT_EQ(lasting[1], Labels{"theme"}) << "what goes on in the next world is new to all";
}

TEST_F(SoundBroadcasterTest, LoopsAreStoppedEvenAfter100LaterTunes) {
  play(1);
  tick();
  view.sounds = {{"siren", df::SoundPlayed::kPlay, false, true, 0}};
  tick();
  for (int i = 0; i < 100; ++i) {
    view.sounds = {{"tune " + std::to_string(i), df::SoundPlayed::kPlay, true, false, 0}};
    tick();
  }
  changeWorld();
  ASSERT_EQ(lasting[1].size(), kMaxSounds);
  EXPECT_EQ(lasting[1].front(), "-siren");
  EXPECT_EQ(lasting[1].back(), "-tune 99");
}

TEST_F(SoundBroadcasterTest, SoundLabelsAreTruncatedAndSanitized) {
  sound(std::string(100, 'x') + "\x1b");
  sound("\xff\x1b[2J");
  tick();
  ASSERT_EQ(once[1].size(), 2u);
  EXPECT_EQ(once[1][0], std::string(kMaxSoundLabel, 'x'));
  EXPECT_EQ(once[1][1], "??[2J");
}

TEST_F(SoundBroadcasterTest, WhatCannotBeSentIsCounted) {
  sends = false;
  sound("fire");
  tick();
  EXPECT_EQ(news.sent(), 0u);
  EXPECT_EQ(news.dropped(), 2u);
}

TEST_F(SoundBroadcasterTest, SoundsOverThePerTickLimitAreCounted) {
  play(1);
  for (int i = 0; i < 200; ++i) sound(std::to_string(i));
  view.sounds_lost = 7;
  tick();
  EXPECT_EQ(once[1].size(), SoundBroadcaster::kPerTick);
  EXPECT_EQ(news.dropped(), 200u - SoundBroadcaster::kPerTick + 7u);
}

class PlayerListBroadcasterTest : public testing::Test {
 protected:
  void play(int players) {
    facts.clear();
    for (int i = 1; i <= players; ++i)
      facts.push_back({.id = static_cast<std::uint32_t>(i), .name = std::to_string(i)});
  }
  /// Runs the ticks. Returns the last list that each player got, as names.
  std::map<std::uint32_t, std::vector<std::string>> listsSent(std::uint32_t from, std::uint32_t to) {
    std::map<std::uint32_t, std::vector<std::string>> heard;
    for (std::uint32_t tick = from; tick < to; ++tick) {
      news.tick(
          tick, facts, [](std::uint32_t player) { return player; },
          [&](std::uint32_t player, const wire::ServerMessage& message) {
            ++messages;
            EXPECT_LE(message.ByteSizeLong(), kMaxServerFrame);
            heard[player].clear();
            for (const auto& entry : message.players().players()) heard[player].push_back(entry.name());
          });
    }
    return heard;
  }
  PlayerListBroadcaster news;
  std::vector<ListedPlayer> facts;
  int messages = 0;
};

TEST_F(PlayerListBroadcasterTest, ChangedListIsSentInFullToAllPlayers) {
  play(3);
  EXPECT_EQ(listsSent(1, 16).size(), 3u);
  EXPECT_EQ(listsSent(16, 100).size(), 0u) << "nothing has changed";
  news.repeat();
  EXPECT_EQ(listsSent(100, 120).size(), 3u);
  facts[1].score = 7;
  const auto heard = listsSent(120, 150);
  EXPECT_EQ(heard.at(3), (std::vector<std::string>{"1", "2", "3"}));
}

TEST_F(PlayerListBroadcasterTest, ListOfTheLongestNamesFitsAFrame) {
  play(static_cast<int>(kMaxPlayers));
  for (auto& player : facts) {
    player.id += 100'000;
    player.name = std::string(kMaxNameBytes, 'x');
    player.score = -1'000'000'000;
  }
  const auto heard = listsSent(1, 16);  // also checks the length of each message
  EXPECT_EQ(heard.size(), facts.size());
  EXPECT_GT(heard.begin()->second.size(), kMaxPlayers / 2);
}

TEST_F(PlayerListBroadcasterTest, LargeListsHaveOnlyBestAndOwnEntries) {
  const int many = static_cast<int>(kMaxPlayers) + 800;
  play(many);
  facts[899].score = 5;
  const auto heard = listsSent(1, 1 + PlayerListBroadcaster::kCrowdInterval);
  EXPECT_EQ(heard.size(), facts.size()) << "each player got one";
  EXPECT_EQ(messages, many) << "once";
  EXPECT_EQ(heard.at(500).size(), PlayerListBroadcaster::kCrowdEntries + 1);
  EXPECT_EQ(heard.at(500).front(), "900");
  EXPECT_EQ(heard.at(500).back(), "500");
  EXPECT_EQ(heard.at(900).size(), PlayerListBroadcaster::kCrowdEntries) << "is among the best";
}

TEST_F(PlayerListBroadcasterTest, NoTickSendsMoreThanItsShare) {
  play(1500);
  for (std::uint32_t tick = 1; tick < 400; ++tick) {
    messages = 0;
    listsSent(tick, tick + 1);
    EXPECT_LE(messages, 10) << tick;
  }
}

}  // namespace
}  // namespace naiad
