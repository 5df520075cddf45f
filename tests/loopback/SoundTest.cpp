// All players hear a game's sounds.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "TestClient.h"
#include "TestServer.h"
#include "engine/events/EventKeyboard.h"
#include "engine/world/Music.h"
#include "engine/world/Sound.h"

namespace naiad::test {
namespace {

/// Plays the theme from the beginning. M pauses it; SPACE fires.
struct Band : df::Object {
  Band() {
    setSolidness(df::SPECTRAL);
    registerInterest(df::KEYBOARD_EVENT);
    fire.setLabel("fire");
    theme.setLabel("theme");
    theme.play();
  }
  int eventHandler(const df::Event* p_event) override {
    const auto* p_key = dynamic_cast<const df::EventKeyboard*>(p_event);
    if (p_key == nullptr) return 0;
    if (p_key->getKey() == df::Keyboard::SPACE) fire.play();
    if (p_key->getKey() == df::Keyboard::M) theme.pause();
    return 1;
  }
  df::Sound fire;
  df::Music theme;
};

/// Returns all sounds that a client has heard: "label" when one starts, "-label" when it stops.
std::vector<std::string> heardBy(TestClient& client, std::vector<std::string>& heard) {
  for (const SoundLine& sound : client.session().popSounds())
    heard.push_back((sound.action == SoundLine::Action::kPlay ? "" : "-") + sound.label);
  return heard;
}

TEST(SoundPlay, SoundsReachAllPlayersAndMusicReachesNewPlayers) {
  TestServer server([](df::World&) { new Band; });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  TestClient bob(context, server.port(), "bob");
  std::vector<std::string> by_ann, by_bob;
  const std::vector<std::string> theme{"theme"};
  ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] {
    return ann.joined() && bob.joined() && heardBy(ann, by_ann) == theme && heardBy(bob, by_bob) == theme;
  })) << "begun before anybody was there";

  ann.session().sendKey(df::Keyboard::SPACE, df::KEY_PRESSED, std::chrono::steady_clock::now());
  const std::vector<std::string> fired{"theme", "fire"};
  ASSERT_TRUE(serveUntil(context, {&ann, &bob},
                         [&] { return heardBy(ann, by_ann) == fired && heardBy(bob, by_bob) == fired; }));
  bob.session().sendKey(df::Keyboard::M, df::KEY_PRESSED, std::chrono::steady_clock::now());
  const std::vector<std::string> paused{"theme", "fire", "-theme"};
  ASSERT_TRUE(serveUntil(context, {&ann, &bob},
                         [&] { return heardBy(ann, by_ann) == paused && heardBy(bob, by_bob) == paused; }));
  EXPECT_EQ(server.counters().sounds, 6u);
  EXPECT_EQ(server.counters().sounds_dropped, 0u);
}

}  // namespace
}  // namespace naiad::test
