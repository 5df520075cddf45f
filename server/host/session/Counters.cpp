#include "host/session/Counters.h"

namespace naiad {

std::string Counters::summary() const {
  return listCounters({
      {"ticks", ticks},
      {"connections", connections},
      {"joined", joined},
      {"turned_away", turned_away},
      {"refused_version", refused_version},
      {"refused_full", refused_full},
      {"refused_address", refused_address},
      {"refused_closing", refused_closing},
      {"refused_game", refused_game},
      {"refused_name", refused_name},
      {"refused_password", refused_password},
      {"refused_banned", refused_banned},
      {"refused_busy", refused_busy},
      {"refused_room", refused_room},
      {"room_moves", room_moves},
      {"room_moves_refused", room_moves_refused},
      {"room_requests_dropped", room_requests_dropped},
      {"chat_muted", chat_muted},
      {"inactive", inactive},
      {"detached", detached},
      {"resumed", resumed},
      {"restarted", restarted},
      {"restored", restored},
      {"returned", returned},
      {"second_streams", second_streams},
      {"resumes_deferred", resumes_deferred},
      {"seconds_deferred", seconds_deferred},
      {"refused_elsewhere", refused_elsewhere},
      {"unknown_tokens", unknown_tokens},
      {"kept_overflows", kept_overflows},
      {"chat_left_out", chat_left_out},
      {"repeated_frames", repeated_frames},
      {"stuck_streams", stuck_streams},
      {"graces_expired", graces_expired},
      {"divergences", divergences},
      {"resets", resets},
      {"resets_dropped", resets_dropped},
      {"checksums_dropped", checksums_dropped},
      {"malformed_frames", malformed_frames},
      {"malformed_messages", malformed_messages},
      {"login_timeouts", login_timeouts},
      {"idle_timeouts", idle_timeouts},
      {"input_floods", input_floods},
      {"message_floods", message_floods},
      {"repeated_inputs", repeated_inputs},
      {"chat_dropped", chat_dropped},
      {"resizes_deferred", resizes_deferred},
      {"sounds", sounds},
      {"sounds_dropped", sounds_dropped},
      {"snapshots", snapshots},
      {"snapshot_bytes", snapshot_bytes},
      {"skipped_ticks", skipped_ticks},
      {"late_ticks", late_ticks},
      {"late_worlds", late_worlds},
      {"rebased_ticks", rebased_ticks},
      {"datagram_snapshots", datagram_snapshots},
      {"datagram_snapshot_bytes", datagram_snapshot_bytes},
      {"inputs", inputs},
      {"late_inputs", late_inputs},
      {"left_asked", left_asked},
      {"left_dismissed", left_dismissed},
      {"left_hung_up", left_hung_up},
      {"left_silent", left_silent},
      {"left_flood", left_flood},
      {"left_malformed", left_malformed},
      {"left_stuck", left_stuck},
      {"rounds_over", rounds_over},
      {"rounds_crashed", rounds_crashed},
      {"rounds_hung", rounds_hung},
      {"rounds_broken", rounds_broken},
      {"rounds_unrecovered", rounds_unrecovered},
      {"scores", scores},
      {"scores_refused", scores_refused},
      {"scores_written", scores_written},
      {"scores_dropped", scores_dropped},
      {"platform_requests", platform_requests},
      {"platform_failures", platform_failures},
      {"bus_published", bus_published},
      {"bus_dropped", bus_dropped},
      {"bus_failures", bus_failures},
      {"bus_connections", bus_connections},
      {"audited_pictures", audited_pictures},
      {"audited_cells", audited_cells},
      {"wrong_cells", wrong_cells},
  });
}

std::string listCounters(std::initializer_list<std::pair<const char*, std::uint64_t>> counters) {
  std::string text;
  for (const auto& [name, value] : counters) {
    if (value == 0) continue;
    if (!text.empty()) text += ' ';
    text += std::string(name) + '=' + std::to_string(value);
  }
  return text;
}

}  // namespace naiad
