// One sample of each kind of server message, with every field set.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/replica/Limits.h"

namespace naiad::test {

/// `texts` limits the help lines, sounds and rooms. The default is as many as the protocol allows.
inline std::vector<wire::ServerMessage> serverMessages(const std::string& text,
                                                       std::size_t texts = SIZE_MAX) {
  std::vector<wire::ServerMessage> all(10);
  wire::Welcome& welcome = *all[0].mutable_welcome();
  welcome.set_player(1);
  welcome.set_name(text);
  welcome.set_game(text);
  welcome.set_server(text);
  welcome.set_tick_micros(33'333);
  welcome.set_view_width(kMaxViewWidth);
  welcome.set_view_height(kMaxViewHeight);
  welcome.set_color(7);
  for (std::size_t i = 0; i < std::min(texts, kMaxHelpLines); ++i) welcome.add_help(text);
  welcome.set_tick(1000);
  welcome.set_connection_id(77);
  welcome.set_aead(2);
  welcome.set_epoch(1);
  welcome.set_resume_token("0123456789abcdef");
  all[1].set_snapshot("snapshot");
  for (std::uint32_t i = 1; i <= 5; ++i) {
    wire::PlayerEntry& entry = *all[2].mutable_players()->add_players();
    entry.set_player(i);
    entry.set_name(text);
    entry.set_color(i);
    entry.set_score(-7);
    entry.set_rtt_millis(40);
  }
  all[3].mutable_chat()->set_player(1);
  all[3].mutable_chat()->set_text(text);
  all[4].mutable_refused()->set_reason(wire::Refused::BUSY);
  all[4].mutable_refused()->set_message(text);
  all[5].mutable_goodbye()->set_message(text);
  all[6].mutable_pong()->set_token(9);
  for (std::size_t i = 0; i < std::min(texts, kMaxSounds); ++i) {
    wire::Sound& sound = *all[7].mutable_sounds()->add_sounds();
    sound.set_label(text);
    sound.set_action(wire::Sound::STOP);
    sound.set_music(true);
    sound.set_loop(true);
    sound.set_player(3);
  }
  wire::RoomEntered& entered = *all[8].mutable_entered();
  entered.set_player(2);
  entered.set_room("arcade");
  entered.set_game(text);
  entered.set_view_width(kMaxViewWidth);
  entered.set_view_height(kMaxViewHeight);
  for (std::size_t i = 0; i < std::min(texts, kMaxHelpLines); ++i) entered.add_help(text);
  entered.set_tick(1000);
  entered.set_world_epoch(3);
  for (std::size_t i = 0; i < std::min(texts, kMaxRooms); ++i) {
    wire::RoomEntry& entry = *all[9].mutable_rooms()->add_rooms();
    entry.set_name("room-" + std::to_string(i));
    entry.set_game(text);
    entry.set_players(3);
    entry.set_max_players(8);
    entry.set_asleep(true);
  }
  return all;
}

}  // namespace naiad::test
