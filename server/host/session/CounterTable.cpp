#include "host/session/CounterTable.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace naiad {

namespace {

/// One sample: a counter, minus `less` if that counts a part of it and has a row of its own.
template <class Struct>
struct CounterRow {
  std::uint64_t Struct::*counter;
  std::string_view field;  ///< name in the log; empty: not logged
  std::string_view family;
  std::string_view labels;
  std::string_view help;  ///< help text of the family; only in its first row
  std::uint64_t Struct::*less = nullptr;
};
#define FIELD(Struct, name) &Struct::name, #name

/// True if each counter of the struct has exactly one row. The struct must have no other members.
template <class Struct, std::size_t kRows>
consteval bool hasAll(const std::array<CounterRow<Struct>, kRows>& rows) {
  for (std::size_t i = 0; i < kRows; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (rows[i].counter == rows[j].counter) return false;
    }
  }
  return kRows * sizeof(std::uint64_t) == sizeof(Struct);
}

template <class Struct, std::size_t kRows>
std::vector<CounterSample> samples(const Struct& counters,
                                   const std::array<CounterRow<Struct>, kRows>& rows) {
  std::vector<CounterSample> all;
  for (const auto& row : rows) {
    const std::uint64_t value = counters.*row.counter;
    const std::uint64_t less = row.less != nullptr ? counters.*row.less : 0;
    all.push_back({row.field, value, row.family, row.labels, row.help, value - std::min(less, value)});
  }
  return all;
}

using C = Counters;
constexpr auto kHostRows = std::to_array<CounterRow<C>>({
    {FIELD(C, ticks), "naiad_ticks_total", "", "Ticks begun."},
    {FIELD(C, late_ticks), "naiad_late_ticks_total", "",
     "Ticks that began more than 5 ms after their deadline."},
    {FIELD(C, rebased_ticks), "naiad_rebased_ticks_total", "",
     "Ticks that were a whole tick late, so that the schedule began again."},
    {FIELD(C, late_worlds), "naiad_late_worlds_total", "",
     "Ticks that a world in a process of its own missed, since it had not ended the one before."},
    {FIELD(C, connections), "naiad_connections_total", "", "Connections that may become sessions."},
    {FIELD(C, joined), "naiad_joins_total", "", "Players who were let in."},
    {FIELD(C, left_asked), "naiad_leaves_total", R"(reason="asked")", "Players who left, by reason."},
    {FIELD(C, left_dismissed), "naiad_leaves_total", R"(reason="dismissed")", ""},
    {FIELD(C, left_hung_up), "naiad_leaves_total", R"(reason="hung_up")", ""},
    {FIELD(C, left_silent), "naiad_leaves_total", R"(reason="silent")", ""},
    {FIELD(C, left_flood), "naiad_leaves_total", R"(reason="flood")", ""},
    {FIELD(C, left_malformed), "naiad_leaves_total", R"(reason="malformed")", ""},
    {FIELD(C, left_stuck), "naiad_leaves_total", R"(reason="stuck")", ""},
    {FIELD(C, refused_version), "naiad_refusals_total", R"(reason="version")",
     "Clients that were not let in, by reason."},
    {FIELD(C, refused_full), "naiad_refusals_total", R"(reason="full")", ""},
    {FIELD(C, refused_address), "naiad_refusals_total", R"(reason="address")", ""},
    {FIELD(C, refused_closing), "naiad_refusals_total", R"(reason="closing")", ""},
    {FIELD(C, refused_game), "naiad_refusals_total", R"(reason="game")", ""},
    {FIELD(C, refused_name), "naiad_refusals_total", R"(reason="name")", ""},
    {FIELD(C, refused_banned), "naiad_refusals_total", R"(reason="banned")", ""},
    {FIELD(C, refused_password), "naiad_refusals_total", R"(reason="password")", ""},
    {FIELD(C, refused_busy), "naiad_refusals_total", R"(reason="busy")", ""},
    {FIELD(C, refused_room), "naiad_refusals_total", R"(reason="room")", ""},
    {FIELD(C, refused_elsewhere), "naiad_refusals_total", R"(reason="elsewhere")", ""},
    {FIELD(C, turned_away), "naiad_refusals_total", R"(reason="crowded")", ""},
    {FIELD(C, login_timeouts), "naiad_refusals_total", R"(reason="late")", ""},
    {FIELD(C, sent_on), "naiad_sent_on_total", "",
     "Clients that were sent to another server, which has places."},
    {FIELD(C, malformed_frames), "naiad_malformed_total", R"(kind="frame")",
     "Frames and messages that no client sends; each ended its connection."},
    {FIELD(C, malformed_messages), "naiad_malformed_total", R"(kind="message")", ""},
    {FIELD(C, input_floods), "naiad_floods_total", R"(kind="input")",
     "Sessions ended, since they sent too much at once."},
    {FIELD(C, message_floods), "naiad_floods_total", R"(kind="message")", ""},
    {FIELD(C, idle_timeouts), "naiad_idle_timeouts_total", "",
     "Connections of players that were silent for too long."},
    {FIELD(C, stuck_streams), "naiad_stuck_streams_total", "",
     "Sessions ended, since they took in too little."},
    {FIELD(C, detached), "naiad_detaches_total", "", "Connections that broke while their session goes on."},
    {FIELD(C, graces_expired), "naiad_graces_expired_total", "", "Players who did not come back in time."},
    {FIELD(C, resumed), "naiad_resumes_total", R"(kind="stream")", "Sessions that go on, by what is new.",
     &C::restarted},
    {FIELD(C, restarted), "naiad_resumes_total", R"(kind="process")", ""},
    {FIELD(C, restored), "naiad_restored_sessions_total", "", "Sessions of a server that was killed."},
    {FIELD(C, returned), "naiad_returned_clients_total", "", "Clients that came back to restored sessions."},
    {FIELD(C, second_streams), "naiad_resumes_total", R"(kind="second_stream")", ""},
    {FIELD(C, resumes_deferred), "naiad_resumes_deferred_total", R"(kind="stream")",
     "Clients that came back more often than allowed."},
    {FIELD(C, seconds_deferred), "naiad_resumes_deferred_total", R"(kind="second_stream")", ""},
    {FIELD(C, unknown_tokens), "naiad_unknown_tokens_total", "",
     "Clients that came back to no session that is there."},
    {FIELD(C, inputs), "naiad_inputs_total", "", "Keys and clicks received."},
    {FIELD(C, late_inputs), "naiad_late_inputs_total", "",
     "Keys and clicks that came after the tick that they were meant for."},
    {FIELD(C, repeated_inputs), "naiad_repeated_total", R"(kind="input")",
     "What had come before, and was ignored."},
    {FIELD(C, repeated_frames), "naiad_repeated_total", R"(kind="frame")", ""},
    {FIELD(C, snapshots), "naiad_snapshots_total", R"(path="stream")", "Snapshots sent, by path.",
     &C::datagram_snapshots},
    {FIELD(C, datagram_snapshots), "naiad_snapshots_total", R"(path="datagram")", ""},
    {FIELD(C, snapshot_bytes), "naiad_snapshot_bytes_total", R"(path="stream")",
     "Bytes of snapshots sent, by path.", &C::datagram_snapshot_bytes},
    {FIELD(C, datagram_snapshot_bytes), "naiad_snapshot_bytes_total", R"(path="datagram")", ""},
    {FIELD(C, skipped_ticks), "naiad_skipped_ticks_total", "",
     "Ticks of players that were not brought up to date, since their line was busy."},
    {FIELD(C, divergences), "naiad_divergences_total", "",
     "Clients whose world was not what they were sent."},
    {FIELD(C, resets), "naiad_world_resets_total", "", "Worlds that were sent again from the beginning."},
    {FIELD(C, resets_dropped), "naiad_world_resets_dropped_total", "", "The same, asked for too often."},
    {FIELD(C, checksums_dropped), "naiad_checksums_dropped_total", "",
     "Checksums of clients that came too often."},
    {FIELD(C, sounds), "naiad_sounds_total", "", "Sounds sent, for each player."},
    {FIELD(C, sounds_dropped), "naiad_sounds_dropped_total", "", "Sounds not sent, since a line was busy."},
    {FIELD(C, kept_overflows), "naiad_left_out_total", R"(kind="sound")",
     "What was left out for a player, since too much was kept for them."},
    {FIELD(C, chat_left_out), "naiad_left_out_total", R"(kind="chat")", ""},
    {FIELD(C, chat_dropped), "naiad_chat_dropped_total", "", "Lines of chat that came too fast."},
    {FIELD(C, room_moves), "naiad_room_moves_total", "", "Players who went to another room."},
    {FIELD(C, room_moves_refused), "naiad_room_moves_refused_total", "",
     "Players who could not: there is no such room, or it is full or cannot begin."},
    {FIELD(C, room_requests_dropped), "naiad_room_requests_dropped_total", "",
     "Requests for the list of rooms or another room that came too often."},
    {FIELD(C, chat_muted), "naiad_chat_muted_total", "",
     "Lines of chat of muted players, which reached nobody."},
    {FIELD(C, inactive), "naiad_inactive_total", "", "Players who had to go since they pressed no key."},
    {FIELD(C, resizes_deferred), "naiad_resizes_deferred_total", "",
     "Sizes of terminals that a newer one replaced."},
    {FIELD(C, rounds_over), "naiad_world_ends_total", R"(reason="game_over")",
     "Worlds in processes of their own that ended, by reason."},
    {FIELD(C, rounds_crashed), "naiad_world_ends_total", R"(reason="crashed")", ""},
    {FIELD(C, rounds_hung), "naiad_world_ends_total", R"(reason="hung")", ""},
    {FIELD(C, rounds_broken), "naiad_world_ends_total", R"(reason="broken")", ""},
    {FIELD(C, rounds_unrecovered), "naiad_world_ends_total", R"(reason="not_recovered")", ""},
    {FIELD(C, taken_over_by_copies), "naiad_take_overs_total", R"(by="copy")",
     "Worlds that crashed or hung while their round went on in another process."},
    {FIELD(C, taken_over_by_worlds), "naiad_take_overs_total", R"(by="another_world")", ""},
    {FIELD(C, scores), "naiad_scores_total", "", "Scores that games added."},
    {FIELD(C, scores_refused), "naiad_scores_refused_total", "",
     "Scores that were no good, or of too many tables."},
    {FIELD(C, scores_written), "naiad_scores_written_total", "", "Scores that are on disk."},
    {FIELD(C, scores_dropped), "naiad_scores_dropped_total", "",
     "Scores that are not written, since too many waited for the disk."},
    {FIELD(C, platform_requests), "naiad_platform_requests_total", R"(result="good")",
     "Requests to what runs the server, by what became of them."},
    {FIELD(C, platform_failures), "naiad_platform_requests_total", R"(result="failed")", ""},
    {FIELD(C, bus_published), "naiad_bus_messages_total", R"(result="arrived")",
     "Messages to the bus, by what became of them; failed ones are tried again."},
    {FIELD(C, bus_failures), "naiad_bus_messages_total", R"(result="failed")", ""},
    {FIELD(C, bus_dropped), "naiad_bus_messages_total", R"(result="dropped")", ""},
    {FIELD(C, bus_connections), "naiad_bus_connections_total", "", "Times that the bus was connected."},
    {FIELD(C, audited_pictures), "naiad_audit_pictures_total", "",
     "Pictures of players that were held against the world's."},
    {FIELD(C, audited_cells), "naiad_audit_cells_total", "", "Cells of these pictures."},
    {FIELD(C, wrong_cells), "naiad_audit_wrong_cells_total", "",
     "Cells of these pictures that were not the world's."},
});
static_assert(hasAll(kHostRows));

using P = PasswordCheck::Counters;
constexpr auto kPasswordRows = std::to_array<CounterRow<P>>({
    {FIELD(P, right), "naiad_passwords_total", R"(result="right")", "Passwords, by what became of them."},
    {FIELD(P, wrong), "naiad_passwords_total", R"(result="wrong")", ""},
    {FIELD(P, unfit), "naiad_passwords_total", R"(result="unfit")", ""},
    {FIELD(P, too_many), "naiad_passwords_total", R"(result="too_many")", ""},
    {FIELD(P, busy), "naiad_passwords_total", R"(result="busy")", ""},
});
static_assert(hasAll(kPasswordRows));

using S = TcpListener::Counters;
constexpr auto kStreamRows = std::to_array<CounterRow<S>>({
    {&S::handshakes, "",  // expected, so not logged
     "naiad_handshakes_total", R"(result="done")", "TLS handshakes, by what became of them."},
    {FIELD(S, handshakes_failed), "naiad_handshakes_total", R"(result="failed")", ""},
    {FIELD(S, handshakes_late), "naiad_handshakes_total", R"(result="late")", ""},
    {FIELD(S, half_open_ended), "naiad_streams_refused_total", R"(reason="silent")",
     "Connections that were hung up on before their handshake, by reason."},
    {FIELD(S, refused_half_open), "naiad_streams_refused_total", R"(reason="crowded")", ""},
    {FIELD(S, refused_from_prefix), "naiad_streams_refused_total", R"(reason="address")", ""},
    {FIELD(S, refused_too_often), "naiad_streams_refused_total", R"(reason="too_often")", ""},
    {FIELD(S, refused_banned), "naiad_streams_refused_total", R"(reason="banned")", ""},
    {FIELD(S, failed_accepts), "naiad_failed_accepts_total", "",
     "Connections put off, since descriptors had run out."},
});
static_assert(hasAll(kStreamRows));

using V = VisitorsListener::Counters;
constexpr auto kVisitorRows = std::to_array<CounterRow<V>>({
    {FIELD(V, visitors), "naiad_visitors_total", "", "Connections that doors of this machine brought."},
    {FIELD(V, bad_headers), "naiad_visitors_refused_total", R"(reason="bad_header")",
     "Connections at the visitors' socket that were hung up on, by reason."},
    {FIELD(V, late_headers), "naiad_visitors_refused_total", R"(reason="late")", ""},
    {FIELD(V, crowded), "naiad_visitors_refused_total", R"(reason="crowded")", ""},
    {FIELD(V, refused_peers), "naiad_visitors_refused_total", R"(reason="peer")", ""},
    {FIELD(V, failed_accepts), "naiad_visitors_failed_accepts_total", "",
     "Connections there that were put off, since descriptors had run out."},
});
static_assert(hasAll(kVisitorRows));

using R = RelayCounters;
constexpr auto kRelayRows = std::to_array<CounterRow<R>>({
    {FIELD(R, datagrams_in_dropped), "naiad_relay_datagrams_dropped_total", R"(direction="in")",
     "Datagrams dropped between the threads, since one was behind."},
    {FIELD(R, datagrams_out_dropped), "naiad_relay_datagrams_dropped_total", R"(direction="out")", ""},
    {FIELD(R, streams_overflowed), "naiad_relay_streams_ended_total", R"(direction="in")",
     "Streams ended between the threads, since one was behind."},
    {FIELD(R, streams_clogged), "naiad_relay_streams_ended_total", R"(direction="out")", ""},
    {FIELD(R, unmet), "naiad_relay_unmet_total", "",
     "Connections hung up on, since too many waited for the next tick."},
    {FIELD(R, keyless), "naiad_relay_keyless_total", "", "Sessions whose stream ended before it gave keys."},
});
static_assert(hasAll(kRelayRows));

using G = DatagramGateCounters;
constexpr auto kGateRows = std::to_array<CounterRow<G>>({
    {FIELD(G, delivered), "naiad_datagrams_delivered_total", "", "Datagrams that were authentic."},
    {FIELD(G, too_short), "naiad_datagrams_refused_total", R"(reason="too_short")",
     "Datagrams refused, by reason."},
    {FIELD(G, too_long), "naiad_datagrams_refused_total", R"(reason="too_long")", ""},
    {FIELD(G, bad_kind), "naiad_datagrams_refused_total", R"(reason="bad_kind")", ""},
    {FIELD(G, unknown_id), "naiad_datagrams_refused_total", R"(reason="unknown_id")", ""},
    {FIELD(G, session_flood), "naiad_datagrams_refused_total", R"(reason="session_flood")", ""},
    {FIELD(G, claimed_flood), "naiad_datagrams_refused_total", R"(reason="claimed_flood")", ""},
    {FIELD(G, prefix_flood), "naiad_datagrams_refused_total", R"(reason="prefix_flood")", ""},
    {FIELD(G, stranger_flood), "naiad_datagrams_refused_total", R"(reason="stranger_flood")", ""},
    {FIELD(G, refused), "naiad_datagrams_refused_total", R"(reason="not_authentic")", ""},
});
static_assert(hasAll(kGateRows));

using U = UdpCounters;
constexpr auto kUdpRows = std::to_array<CounterRow<U>>({
    {FIELD(U, received), "naiad_network_packets_total", R"(direction="in",transport="udp")",
     "Packets of UDP."},
    {FIELD(U, sent), "naiad_network_packets_total", R"(direction="out",transport="udp")", ""},
    {FIELD(U, dropped_full), "naiad_udp_send_failures_total", R"(reason="full")",
     "Packets of UDP that were not sent."},
    {FIELD(U, send_errors), "naiad_udp_send_failures_total", R"(reason="error")", ""},
    {FIELD(U, receive_errors), "naiad_udp_receive_errors_total", R"(kind="error")",
     "Errors where a packet of UDP was expected, and packets that were too long."},
    {FIELD(U, too_large), "naiad_udp_receive_errors_total", R"(kind="too_large")", ""},
});
static_assert(hasAll(kUdpRows));

using T = TrafficCounters;
constexpr auto kTrafficRows = std::to_array<CounterRow<T>>({
    {FIELD(T, stream_bytes_in), "naiad_network_bytes_total", R"(direction="in",transport="tcp")",
     "Bytes of frames (before TLS) and of UDP's payload."},
    {FIELD(T, stream_bytes_out), "naiad_network_bytes_total", R"(direction="out",transport="tcp")", ""},
    {FIELD(T, datagram_bytes_in), "naiad_network_bytes_total", R"(direction="in",transport="udp")", ""},
    {FIELD(T, datagram_bytes_out), "naiad_network_bytes_total", R"(direction="out",transport="udp")", ""},
    {FIELD(T, frames_in), "naiad_network_frames_total", R"(direction="in")", "Frames of streams."},
    {FIELD(T, frames_out), "naiad_network_frames_total", R"(direction="out")", ""},
});
static_assert(hasAll(kTrafficRows));

#undef FIELD

}  // namespace

std::vector<CounterSample> samplesOf(const Counters& counters) {
  return samples(counters, kHostRows);
}
std::vector<CounterSample> samplesOf(const PasswordCheck::Counters& counters) {
  return samples(counters, kPasswordRows);
}
std::vector<CounterSample> samplesOf(const TcpListener::Counters& counters) {
  return samples(counters, kStreamRows);
}
std::vector<CounterSample> samplesOf(const VisitorsListener::Counters& counters) {
  return samples(counters, kVisitorRows);
}
std::vector<CounterSample> samplesOf(const RelayCounters& counters) {
  return samples(counters, kRelayRows);
}
std::vector<CounterSample> samplesOf(const DatagramGateCounters& counters) {
  return samples(counters, kGateRows);
}
std::vector<CounterSample> samplesOf(const UdpCounters& counters) {
  return samples(counters, kUdpRows);
}
std::vector<CounterSample> samplesOf(const TrafficCounters& counters) {
  return samples(counters, kTrafficRows);
}

std::string Counters::summary() const {
  return listCounters(samplesOf(*this));
}

std::string listCounters(const std::vector<CounterSample>& samples) {
  std::string text;
  for (const CounterSample& sample : samples) {
    if (sample.value == 0 || sample.field.empty()) continue;
    if (!text.empty()) text += ' ';
    text += std::string(sample.field) + '=' + std::to_string(sample.value);
  }
  return text;
}

}  // namespace naiad
