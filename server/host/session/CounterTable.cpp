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
     "Ticks that were a whole tick late, so the schedule was reset."},
    {FIELD(C, world_missed_ticks), "naiad_world_missed_ticks_total", "",
     "Ticks that a game process missed because its previous tick was still running."},
    {FIELD(C, connections), "naiad_connections_total", "", "Connections accepted."},
    {FIELD(C, joined), "naiad_joins_total", "", "Players that joined."},
    {FIELD(C, left_voluntarily), "naiad_leaves_total", R"(reason="voluntary")",
     "Players that left, by reason."},
    {FIELD(C, left_dismissed), "naiad_leaves_total", R"(reason="dismissed")", ""},
    {FIELD(C, left_disconnected), "naiad_leaves_total", R"(reason="disconnected")", ""},
    {FIELD(C, left_silent), "naiad_leaves_total", R"(reason="silent")", ""},
    {FIELD(C, left_flood), "naiad_leaves_total", R"(reason="flood")", ""},
    {FIELD(C, left_malformed), "naiad_leaves_total", R"(reason="malformed")", ""},
    {FIELD(C, left_stalled), "naiad_leaves_total", R"(reason="stalled")", ""},
    {FIELD(C, refused_version), "naiad_refusals_total", R"(reason="version")", "Clients refused, by reason."},
    {FIELD(C, refused_full), "naiad_refusals_total", R"(reason="full")", ""},
    {FIELD(C, refused_address), "naiad_refusals_total", R"(reason="address")", ""},
    {FIELD(C, refused_closing), "naiad_refusals_total", R"(reason="closing")", ""},
    {FIELD(C, refused_game), "naiad_refusals_total", R"(reason="game")", ""},
    {FIELD(C, refused_name), "naiad_refusals_total", R"(reason="name")", ""},
    {FIELD(C, refused_banned), "naiad_refusals_total", R"(reason="banned")", ""},
    {FIELD(C, refused_password), "naiad_refusals_total", R"(reason="password")", ""},
    {FIELD(C, refused_busy), "naiad_refusals_total", R"(reason="busy")", ""},
    {FIELD(C, refused_room), "naiad_refusals_total", R"(reason="room")", ""},
    {FIELD(C, refused_session_moved), "naiad_refusals_total", R"(reason="session_moved")", ""},
    {FIELD(C, connections_rejected), "naiad_refusals_total", R"(reason="overloaded")", ""},
    {FIELD(C, login_timeouts), "naiad_refusals_total", R"(reason="hello_timeout")", ""},
    {FIELD(C, redirected), "naiad_redirects_total", "",
     "Clients redirected to another server with free places."},
    {FIELD(C, malformed_frames), "naiad_malformed_total", R"(kind="frame")",
     "Invalid frames and messages; each ended its connection."},
    {FIELD(C, malformed_messages), "naiad_malformed_total", R"(kind="message")", ""},
    {FIELD(C, input_floods), "naiad_floods_total", R"(kind="input")",
     "Sessions ended because they sent too much at once."},
    {FIELD(C, message_floods), "naiad_floods_total", R"(kind="message")", ""},
    {FIELD(C, idle_timeouts), "naiad_idle_timeouts_total", "", "Connections of players that timed out."},
    {FIELD(C, stalled_streams), "naiad_stalled_streams_total", "",
     "Sessions ended because the client received too slowly."},
    {FIELD(C, detached), "naiad_detaches_total", "", "Connections lost whose session continues."},
    {FIELD(C, reconnect_timeouts), "naiad_reconnect_timeouts_total", "",
     "Players that did not reconnect in time."},
    {FIELD(C, resumed), "naiad_resumes_total", R"(kind="stream")", "Sessions resumed, by what is new.",
     &C::restarted},
    {FIELD(C, restarted), "naiad_resumes_total", R"(kind="process")", ""},
    {FIELD(C, restored), "naiad_restored_sessions_total", "", "Sessions restored from a killed server."},
    {FIELD(C, returned), "naiad_returned_clients_total", "",
     "Clients that reconnected to restored sessions."},
    {FIELD(C, second_streams), "naiad_resumes_total", R"(kind="second_stream")", ""},
    {FIELD(C, resumes_deferred), "naiad_resumes_deferred_total", R"(kind="stream")",
     "Reconnects refused because they were too frequent."},
    {FIELD(C, second_streams_deferred), "naiad_resumes_deferred_total", R"(kind="second_stream")", ""},
    {FIELD(C, unknown_tokens), "naiad_unknown_tokens_total", "", "Reconnects with an unknown token."},
    {FIELD(C, inputs), "naiad_inputs_total", "", "Keys and clicks received."},
    {FIELD(C, late_inputs), "naiad_late_inputs_total", "", "Keys and clicks that came after their tick."},
    {FIELD(C, repeated_inputs), "naiad_repeated_total", R"(kind="input")",
     "Duplicate inputs and reliable frames, which were ignored."},
    {FIELD(C, repeated_frames), "naiad_repeated_total", R"(kind="frame")", ""},
    {FIELD(C, snapshots), "naiad_snapshots_total", R"(path="stream")", "Snapshots sent, by path.",
     &C::datagram_snapshots},
    {FIELD(C, datagram_snapshots), "naiad_snapshots_total", R"(path="datagram")", ""},
    {FIELD(C, snapshot_bytes), "naiad_snapshot_bytes_total", R"(path="stream")",
     "Bytes of snapshots sent, by path.", &C::datagram_snapshot_bytes},
    {FIELD(C, datagram_snapshot_bytes), "naiad_snapshot_bytes_total", R"(path="datagram")", ""},
    {FIELD(C, skipped_ticks), "naiad_skipped_ticks_total", "",
     "Snapshots skipped because the player's connection was busy."},
    {FIELD(C, divergences), "naiad_divergences_total", "",
     "Wrong checksums that clients reported; any client can report a false one."},
    {FIELD(C, resets), "naiad_world_resets_total", "", "Worlds sent again from the beginning."},
    {FIELD(C, resets_dropped), "naiad_world_resets_dropped_total", "",
     "Requests to send a world again that were too frequent."},
    {FIELD(C, checksums_dropped), "naiad_checksums_dropped_total", "",
     "Checksums of clients that were ignored because they came too often."},
    {FIELD(C, sounds), "naiad_sounds_total", "", "Sounds sent, for each player."},
    {FIELD(C, sounds_dropped), "naiad_sounds_dropped_total", "",
     "Sounds not sent because a connection was busy."},
    {FIELD(C, outbox_sounds_dropped), "naiad_reliable_dropped_total", R"(kind="sound")",
     "Messages dropped because a player's queue was full."},
    {FIELD(C, outbox_chat_dropped), "naiad_reliable_dropped_total", R"(kind="chat")", ""},
    {FIELD(C, chat_dropped), "naiad_chat_dropped_total", "",
     "Lines of chat that were dropped because they came too often."},
    {FIELD(C, room_transfers), "naiad_room_moves_total", "", "Players that changed rooms."},
    {FIELD(C, room_moves_refused), "naiad_room_moves_refused_total", "",
     "Room changes refused: the room is unknown, full or cannot start."},
    {FIELD(C, room_requests_dropped), "naiad_room_requests_dropped_total", "",
     "Requests for the room list or another room that were too frequent."},
    {FIELD(C, chat_muted), "naiad_chat_muted_total", "", "Chat lines of muted players, not delivered."},
    {FIELD(C, idle_kicks), "naiad_idle_kicks_total", "",
     "Players disconnected because they sent no input for too long."},
    {FIELD(C, resizes_deferred), "naiad_resizes_deferred_total", "",
     "Terminal sizes replaced by a newer one."},
    {FIELD(C, rounds_over), "naiad_world_ends_total", R"(reason="game_over")",
     "Game processes that ended, by reason."},
    {FIELD(C, rounds_crashed), "naiad_world_ends_total", R"(reason="crashed")", ""},
    {FIELD(C, rounds_hung), "naiad_world_ends_total", R"(reason="hung")", ""},
    {FIELD(C, rounds_broken), "naiad_world_ends_total", R"(reason="broken")", ""},
    {FIELD(C, rounds_unrecovered), "naiad_world_ends_total", R"(reason="not_recovered")", ""},
    {FIELD(C, failovers_by_checkpoint), "naiad_failovers_total", R"(source="checkpoint")",
     "Worlds that crashed or hung and were recovered, by what replaced them."},
    {FIELD(C, failovers_by_replay), "naiad_failovers_total", R"(source="replay")", ""},
    {FIELD(C, scores), "naiad_scores_total", "", "Scores added by games."},
    {FIELD(C, scores_refused), "naiad_scores_refused_total", "",
     "Scores refused because they were invalid or the game has too many tables."},
    {FIELD(C, scores_written), "naiad_scores_written_total", "", "Scores written to disk."},
    {FIELD(C, scores_dropped), "naiad_scores_dropped_total", "",
     "Scores not written because too many waited for the disk."},
    {FIELD(C, platform_requests), "naiad_platform_requests_total", R"(result="good")",
     "Requests to the platform, by result."},
    {FIELD(C, platform_failures), "naiad_platform_requests_total", R"(result="failed")", ""},
    {FIELD(C, bus_published), "naiad_bus_messages_total", R"(result="arrived")",
     "Messages to the bus, by result; failed ones are retried."},
    {FIELD(C, bus_failures), "naiad_bus_messages_total", R"(result="failed")", ""},
    {FIELD(C, bus_dropped), "naiad_bus_messages_total", R"(result="dropped")", ""},
    {FIELD(C, bus_connections), "naiad_bus_connections_total", "", "Connections made to the bus."},
    {FIELD(C, bus_lost), "naiad_bus_lost_total", "", "Messages of the bus lost, because too many waited."},
    {FIELD(C, audited_pictures), "naiad_audit_pictures_total", "",
     "Pictures of players that were compared with the world's."},
    {FIELD(C, audited_cells), "naiad_audit_cells_total", "", "Cells of these pictures."},
    {FIELD(C, wrong_cells), "naiad_audit_wrong_cells_total", "",
     "Cells of the audited pictures that differed from the world's."},
});
static_assert(hasAll(kHostRows));

using P = PasswordCheck::Counters;
constexpr auto kPasswordRows = std::to_array<CounterRow<P>>({
    {FIELD(P, right), "naiad_passwords_total", R"(result="right")", "Password checks, by result."},
    {FIELD(P, wrong), "naiad_passwords_total", R"(result="wrong")", ""},
    {FIELD(P, malformed), "naiad_passwords_total", R"(result="malformed")", ""},
    {FIELD(P, too_many), "naiad_passwords_total", R"(result="too_many")", ""},
    {FIELD(P, busy), "naiad_passwords_total", R"(result="busy")", ""},
});
static_assert(hasAll(kPasswordRows));

using S = TcpListener::Counters;
constexpr auto kStreamRows = std::to_array<CounterRow<S>>({
    {&S::handshakes, "",  // expected, so not logged
     "naiad_handshakes_total", R"(result="done")", "TLS handshakes, by result."},
    {FIELD(S, handshakes_failed), "naiad_handshakes_total", R"(result="failed")", ""},
    {FIELD(S, handshakes_late), "naiad_handshakes_total", R"(result="late")", ""},
    {FIELD(S, half_open_ended), "naiad_streams_refused_total", R"(reason="silent")",
     "Connections dropped before the TLS handshake, by reason."},
    {FIELD(S, refused_half_open), "naiad_streams_refused_total", R"(reason="crowded")", ""},
    {FIELD(S, refused_from_prefix), "naiad_streams_refused_total", R"(reason="address")", ""},
    {FIELD(S, refused_too_often), "naiad_streams_refused_total", R"(reason="rate_limited")", ""},
    {FIELD(S, refused_banned), "naiad_streams_refused_total", R"(reason="banned")", ""},
    {FIELD(S, failed_accepts), "naiad_failed_accepts_total", "",
     "Connections that could not be accepted, for example without free descriptors; retried."},
});
static_assert(hasAll(kStreamRows));

using V = ProxyListener::Counters;
constexpr auto kVisitorRows = std::to_array<CounterRow<V>>({
    {FIELD(V, visitors), "naiad_proxied_connections_total", "", "Connections from doors of this machine."},
    {FIELD(V, bad_headers), "naiad_proxied_connections_refused_total", R"(reason="bad_header")",
     "Connections dropped at the socket for doors (--proxy-socket), by reason."},
    {FIELD(V, late_headers), "naiad_proxied_connections_refused_total", R"(reason="late")", ""},
    {FIELD(V, crowded), "naiad_proxied_connections_refused_total", R"(reason="crowded")", ""},
    {FIELD(V, refused_peers), "naiad_proxied_connections_refused_total", R"(reason="peer")", ""},
    {FIELD(V, failed_accepts), "naiad_visitors_failed_accepts_total", "",
     "Failed accepts at that socket because no descriptors were free; retried."},
});
static_assert(hasAll(kVisitorRows));

using R = RelayCounters;
constexpr auto kRelayRows = std::to_array<CounterRow<R>>({
    {FIELD(R, datagrams_in_dropped), "naiad_relay_datagrams_dropped_total", R"(direction="in")",
     "Datagrams dropped because the tick thread (in) or the network thread (out) was behind."},
    {FIELD(R, datagrams_out_dropped), "naiad_relay_datagrams_dropped_total", R"(direction="out")", ""},
    {FIELD(R, streams_overflowed), "naiad_relay_streams_ended_total", R"(direction="in")",
     "Streams ended because the tick thread (in) or the network thread (out) was behind."},
    {FIELD(R, streams_clogged), "naiad_relay_streams_ended_total", R"(direction="out")", ""},
    {FIELD(R, unaccepted), "naiad_relay_unaccepted_total", "",
     "Connections dropped because too many waited for the next tick."},
    {FIELD(R, keyless), "naiad_relay_keyless_total", "",
     "Streams that ended before the keys for datagrams were derived from them."},
});
static_assert(hasAll(kRelayRows));

using G = DatagramDemuxCounters;
constexpr auto kGateRows = std::to_array<CounterRow<G>>({
    {FIELD(G, delivered), "naiad_datagrams_delivered_total", "", "Authentic datagrams received."},
    {FIELD(G, too_short), "naiad_datagrams_refused_total", R"(reason="too_short")",
     "Datagrams refused, by reason."},
    {FIELD(G, too_long), "naiad_datagrams_refused_total", R"(reason="too_long")", ""},
    {FIELD(G, bad_kind), "naiad_datagrams_refused_total", R"(reason="bad_kind")", ""},
    {FIELD(G, unknown_id), "naiad_datagrams_refused_total", R"(reason="unknown_id")", ""},
    {FIELD(G, session_flood), "naiad_datagrams_refused_total", R"(reason="session_flood")", ""},
    {FIELD(G, unvalidated_session_flood), "naiad_datagrams_refused_total",
     R"(reason="unvalidated_session_flood")", ""},
    {FIELD(G, prefix_flood), "naiad_datagrams_refused_total", R"(reason="prefix_flood")", ""},
    {FIELD(G, unvalidated_flood), "naiad_datagrams_refused_total", R"(reason="unvalidated_flood")", ""},
    {FIELD(G, refused), "naiad_datagrams_refused_total", R"(reason="not_authentic")", ""},
});
static_assert(hasAll(kGateRows));

using U = UdpCounters;
constexpr auto kUdpRows = std::to_array<CounterRow<U>>({
    {FIELD(U, received), "naiad_network_packets_total", R"(direction="in",transport="udp")", "UDP packets."},
    {FIELD(U, sent), "naiad_network_packets_total", R"(direction="out",transport="udp")", ""},
    {FIELD(U, dropped_full), "naiad_udp_send_failures_total", R"(reason="full")",
     "UDP packets that could not be sent."},
    {FIELD(U, send_errors), "naiad_udp_send_failures_total", R"(reason="error")", ""},
    {FIELD(U, receive_errors), "naiad_udp_receive_errors_total", R"(kind="error")",
     "Errors while receiving UDP packets, and packets that were too long."},
    {FIELD(U, too_large), "naiad_udp_receive_errors_total", R"(kind="too_large")", ""},
});
static_assert(hasAll(kUdpRows));

using T = TrafficCounters;
constexpr auto kTrafficRows = std::to_array<CounterRow<T>>({
    {FIELD(T, stream_bytes_in), "naiad_network_bytes_total", R"(direction="in",transport="tcp")",
     "Bytes of frames (before TLS) and of UDP payloads."},
    {FIELD(T, stream_bytes_out), "naiad_network_bytes_total", R"(direction="out",transport="tcp")", ""},
    {FIELD(T, datagram_bytes_in), "naiad_network_bytes_total", R"(direction="in",transport="udp")", ""},
    {FIELD(T, datagram_bytes_out), "naiad_network_bytes_total", R"(direction="out",transport="udp")", ""},
    {FIELD(T, frames_in), "naiad_network_frames_total", R"(direction="in")",
     "Frames sent and received on streams."},
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
std::vector<CounterSample> samplesOf(const ProxyListener::Counters& counters) {
  return samples(counters, kVisitorRows);
}
std::vector<CounterSample> samplesOf(const RelayCounters& counters) {
  return samples(counters, kRelayRows);
}
std::vector<CounterSample> samplesOf(const DatagramDemuxCounters& counters) {
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
