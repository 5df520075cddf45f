#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "host/session/Counters.h"
#include "host/session/ReliableOutbox.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/ReliableFrames.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

wire::ServerMessage chatOf(const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_player(1);
  message.mutable_chat()->set_text(text);
  return message;
}

wire::ServerMessage listOf(std::size_t players, std::uint32_t version) {
  wire::ServerMessage message;
  message.mutable_players();
  for (std::size_t i = 1; i <= players; ++i) {
    wire::PlayerEntry& entry = *message.mutable_players()->add_players();
    entry.set_player(static_cast<std::uint32_t>(i));
    entry.set_name(std::string(kMaxNameBytes - 16, 'n'));
    entry.set_score(static_cast<std::int32_t>(version));
  }
  return message;
}

wire::ServerMessage soundOf(const std::string& label, wire::Sound::Action action) {
  wire::ServerMessage message;
  wire::Sound& sound = *message.mutable_sounds()->add_sounds();
  sound.set_label(label);
  sound.set_action(action);
  return message;
}

/// A client's state, read from the frames that reach it.
struct Reader {
  ReliableFrameReceiver heard;
  std::vector<std::string> lines;  ///< chat of players
  std::uint64_t left_out = 0;      ///< number of dropped lines that the server reported
  std::vector<std::uint64_t> notices;
  std::uint32_t list = 0;
  std::map<std::string, int> sounds;

  void read(const std::string& frame) {
    wire::ServerMessage message;
    ASSERT_TRUE(message.ParseFromString(frame));
    ASSERT_NE(message.number(), 0u);
    if (!heard.accept(message.number())) return;
    if (message.has_players()) list = static_cast<std::uint32_t>(message.players().players(0).score());
    for (const wire::Sound& sound : message.sounds().sounds()) sounds[sound.label()] = sound.action();
    if (!message.has_chat()) return;
    if (message.chat().player() != 0) return lines.push_back(message.chat().text());
    notices.push_back(std::stoull(message.chat().text()));
    left_out += notices.back();
  }
};

class ReliableOutboxTest : public testing::Test {
 protected:
  void deliver() {
    while (const std::string* p_frame = outbox.next()) {
      reader.read(*p_frame);
      outbox.markSent();
    }
  }
  void deliverAll() {
    for (std::size_t before = 0; before != outbox.bytes() || outbox.next() != nullptr;) {
      before = outbox.bytes();
      deliver();
      outbox.acknowledge(reader.heard.newest());
    }
    EXPECT_EQ(outbox.bytes(), 0u);
  }

  Counters counters;
  ReliableOutbox outbox{counters};
  Reader reader;
};

TEST_F(ReliableOutboxTest, FramesStayUntilTheyAreAcknowledged) {
  for (const char* text : {"a", "b", "c"}) outbox.add(chatOf(text));
  deliver();
  EXPECT_EQ(reader.lines, (std::vector<std::string>{"a", "b", "c"}));
  outbox.acknowledge(2);
  outbox.acknowledge(1);
  outbox.acknowledge(0);
  outbox.acknowledge(77);  // a number that was never sent
  outbox.restartStream();
  reader = {};
  deliver();
  EXPECT_EQ(reader.lines, std::vector<std::string>{"c"});
  outbox.acknowledge(3);
  EXPECT_EQ(outbox.bytes(), 0u);
}

TEST_F(ReliableOutboxTest, AnAcknowledgementCountsOnTheNextStreamToo) {
  for (const char* text : {"a", "b", "c"}) outbox.add(chatOf(text));
  deliver();
  outbox.restartStream();
  outbox.markSent();
  outbox.acknowledge(3);  // all arrived on the earlier stream
  EXPECT_EQ(outbox.bytes(), 0u);
}

TEST_F(ReliableOutboxTest, OnlyTheNewestStateOfASoundIsKept) {
  for (int i = 0; i < 10'000; ++i) {
    outbox.add(soundOf("theme", wire::Sound::PLAY));
    outbox.add(soundOf("siren", wire::Sound::PLAY));
    outbox.add(soundOf("theme", wire::Sound::STOP));
  }
  EXPECT_LT(outbox.bytes(), 200u);
  deliver();
  EXPECT_EQ(reader.sounds, (std::map<std::string, int>{{"theme", wire::Sound::STOP}, {"siren", 0}}));
  EXPECT_EQ(counters.outbox_sounds_dropped, 0u);
}

TEST_F(ReliableOutboxTest, FullOutboxDropsOldestChatAndReportsTheCount) {
  outbox.add(listOf(200, 1));
  outbox.add(soundOf("theme", wire::Sound::PLAY));
  for (int i = 0; i < 500; ++i) outbox.add(chatOf(std::to_string(i) + std::string(200, 'x')));
  EXPECT_LE(outbox.bytes(), ReliableOutbox::kMax);
  EXPECT_GT(outbox.bytes(), ReliableOutbox::kMax - 250);
  deliverAll();
  EXPECT_EQ(reader.list, 1u);
  EXPECT_EQ(reader.sounds.count("theme"), 1u);
  ASSERT_EQ(reader.notices.size(), 1u);
  EXPECT_EQ(reader.lines.size() + reader.left_out, 500u);
  EXPECT_EQ(reader.lines.front().substr(0, 4), std::to_string(reader.left_out) + "x");
  EXPECT_EQ(reader.lines.back().substr(0, 4), "499x");
  EXPECT_EQ(counters.outbox_chat_dropped, reader.left_out);
}

TEST_F(ReliableOutboxTest, NoMoreThanAWindowIsUnacknowledged) {
  for (int i = 0; i < 200; ++i) outbox.add(chatOf(std::string(100, 'x')));
  std::size_t bytes = 0;
  for (; const std::string* p_frame = outbox.next(); outbox.markSent()) bytes += p_frame->size();
  EXPECT_LT(bytes, ReliableOutbox::kWindow + 200);
  EXPECT_GT(bytes, ReliableOutbox::kWindow / 2) << "a client acknowledges after 8 KiB";
  outbox.acknowledge(80);
  EXPECT_NE(outbox.next(), nullptr);
}

/// Other players join, leave and score, while chat lines always wait to be sent.
TEST_F(ReliableOutboxTest, ConstantlyChangingListIsStillSent) {
  for (std::uint32_t version = 1; version <= 2'000; ++version) {
    outbox.add(listOf(200, version));
    outbox.add(chatOf(std::string(200, 'x')));
    outbox.add(chatOf(std::string(200, 'x')));
    EXPECT_LE(outbox.bytes(), ReliableOutbox::kMax);
    if (const std::string* p_frame = outbox.next()) {  // sends one of every two lines
      reader.read(*p_frame);
      outbox.markSent();
      outbox.acknowledge(reader.heard.newest());
    }
  }
  EXPECT_GT(reader.list, 1'800u);
}

TEST_F(ReliableOutboxTest, SoundFloodUsesAtMostHalfTheOutbox) {
  outbox.add(listOf(200, 7));
  for (int i = 0; i < 100'000; ++i)
    outbox.add(soundOf(std::to_string(i) + std::string(100, 's'), wire::Sound::PLAY));
  EXPECT_LE(outbox.bytes(), ReliableOutbox::kMax / 2);
  EXPECT_GT(counters.outbox_sounds_dropped, 90'000u);
  outbox.add(chatOf("line"));
  deliverAll();
  EXPECT_EQ(reader.list, 7u);
  EXPECT_EQ(reader.lines.size(), 1u);
  EXPECT_EQ(reader.sounds.count("99999" + std::string(100, 's')), 1u) << "the newest";
}

/// Each line arrives once, in order, or is counted once as dropped, whatever is lost or acknowledged.
TEST_F(ReliableOutboxTest, EveryLineArrivesOnceOrIsCountedOnce) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SplitMix64 random(seed);
    counters = {};
    outbox.clear();
    ReliableOutbox one(counters);
    Reader client;
    std::deque<std::string> under_way;
    std::uint64_t said = 0;
    std::uint32_t version = 0;
    std::map<std::string, int> sounds;
    const auto step = [&](std::uint64_t kind) {
      if (kind < 60) {
        one.add(chatOf(std::to_string(said++) + " " + std::string(random.below(300), 'x')));
      } else if (kind < 64) {
        one.add(listOf(1 + random.below(200), ++version));
      } else if (kind < 70) {
        const std::string label = "s" + std::to_string(random.below(20));
        const auto action = static_cast<wire::Sound::Action>(random.below(3));
        sounds[label] = action;
        one.add(soundOf(label, action));
      } else if (kind < 80) {
        if (const std::string* p_frame = one.next()) {
          under_way.push_back(*p_frame);
          one.markSent();
        }
      } else if (kind < 95) {
        if (!under_way.empty()) {
          client.read(under_way.front());
          under_way.pop_front();
        }
      } else if (kind < 99) {
        one.acknowledge(client.heard.newest());
      } else {  // the stream breaks; the client returns at once
        under_way.clear();
        one.acknowledge(client.heard.newest());
        one.restartStream();
      }
      ASSERT_LE(one.bytes(), ReliableOutbox::kMax);
    };
    for (int i = 0; i < 20'000; ++i) step(random.below(i / 4'000 % 2 == 0 ? 65 : 100));
    under_way.clear();
    one.acknowledge(client.heard.newest());
    one.restartStream();
    while (one.bytes() > 0) {
      for (; const std::string* p_frame = one.next(); one.markSent()) client.read(*p_frame);
      one.acknowledge(client.heard.newest());
    }
    EXPECT_EQ(client.lines.size() + client.left_out, said) << "seed " << seed;
    EXPECT_EQ(client.left_out, counters.outbox_chat_dropped);
    EXPECT_GT(client.left_out, 100u);
    EXPECT_EQ(client.list, version);
    EXPECT_EQ(client.sounds, sounds);
    std::uint64_t newest = 0;
    for (std::size_t i = 0; i < client.lines.size(); ++i) {
      const std::uint64_t number = std::stoull(client.lines[i]);
      ASSERT_TRUE(i == 0 || number > newest);
      newest = number;
    }
  }
}

}  // namespace
}  // namespace naiad
