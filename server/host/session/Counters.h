// Counters of a host. Every rejection has one, so nothing is dropped silently.
#pragma once

#include <cstdint>
#include <string>

namespace naiad {

struct Counters {
  std::uint64_t connections = 0;              ///< connections accepted by the listener
  std::uint64_t joined = 0;                   ///< clients that were welcomed
  std::uint64_t connections_rejected = 0;     ///< over the connection limit: closed without an answer
  std::uint64_t refused_version = 0;          ///< wrong protocol version
  std::uint64_t refused_full = 0;             ///< no free place
  std::uint64_t refused_address = 0;          ///< too many players from one address
  std::uint64_t refused_closing = 0;          ///< the server is about to stop
  std::uint64_t refused_game = 0;             ///< requested another game
  std::uint64_t refused_name = 0;             ///< no usable name
  std::uint64_t malformed_frames = 0;         ///< oversized or empty frames: connection ended
  std::uint64_t malformed_messages = 0;       ///< not a message, or a value out of range: connection ended
  std::uint64_t login_timeouts = 0;           ///< no hello, or no decision on it, in time: connection ended
  std::uint64_t idle_timeouts = 0;            ///< connections of players that were silent for too long
  std::uint64_t input_floods = 0;             ///< more inputs queued than allowed: session ended
  std::uint64_t message_floods = 0;           ///< more messages than ClientActivity allows: session ended
  std::uint64_t detached = 0;                 ///< streams that broke while their session continues
  std::uint64_t resumed = 0;                  ///< sessions that continued on another stream
  std::uint64_t restarted = 0;                ///< part of resumed: by another process of the client
  std::uint64_t restored = 0;                 ///< sessions restored from a killed server
  std::uint64_t returned = 0;                 ///< clients that resumed a restored session
  std::uint64_t second_streams = 0;           ///< second streams added where datagrams do not pass
  std::uint64_t resumes_deferred = 0;         ///< attempts to resume more often than allowed: refused for now
  std::uint64_t second_streams_deferred = 0;  ///< second streams over the rate limit: refused for now
  std::uint64_t redirected = 0;  ///< refused_full or refused_closing, with a link to another server
  std::uint64_t refused_session_moved = 0;  ///< the session now belongs to another client process
  std::uint64_t unknown_tokens =
      0;  ///< tokens of ended sessions, guesses, and second streams without a first stream
  std::uint64_t outbox_sounds_dropped = 0;  ///< sounds dropped because too much was kept for a client
  std::uint64_t outbox_chat_dropped =
      0;                              ///< chat lines dropped because too much was kept, counted per client
  std::uint64_t repeated_frames = 0;  ///< duplicate reliable frames: ignored
  std::uint64_t stalled_streams = 0;  ///< more than 64 KiB unsent without progress for 10 s: connection ended
  std::uint64_t reconnect_timeouts = 0;  ///< clients that did not reconnect in time
  std::uint64_t refused_password = 0;    ///< missing or wrong password
  std::uint64_t refused_banned = 0;      ///< players banned by name, or while they connected
  std::uint64_t refused_busy = 0;    ///< temporary: password queue, join limit, recovery, no world can start
  std::uint64_t divergences = 0;     ///< the client reported a wrong checksum, perhaps falsely: reset
  std::uint64_t resets = 0;          ///< worlds sent again, on request or after a divergence
  std::uint64_t resets_dropped = 0;  ///< requests less than two seconds after the last reset: ignored
  std::uint64_t checksums_dropped = 0;      ///< checksums less than 250 ms after the last one: ignored
  std::uint64_t repeated_inputs = 0;        ///< inputs received before: ignored
  std::uint64_t chat_dropped = 0;           ///< lines over the session's or the address's rate limit: ignored
  std::uint64_t chat_muted = 0;             ///< lines of muted players: not forwarded
  std::uint64_t room_transfers = 0;         ///< players who moved to another room
  std::uint64_t room_moves_refused = 0;     ///< unknown or full rooms, or rooms that cannot start
  std::uint64_t room_requests_dropped = 0;  ///< room list or room moves over the rate limit: ignored
  std::uint64_t refused_room = 0;           ///< unknown room
  std::uint64_t idle_kicks = 0;             ///< no key, click or chat line for too long: connection ended
  std::uint64_t sounds = 0;                 ///< sounds sent, counted per player
  std::uint64_t sounds_dropped = 0;         ///< sounds not sent: too many, or the stream was broken or busy
  std::uint64_t resizes_deferred = 0;       ///< terminal sizes replaced by a newer one, not applied
  std::uint64_t snapshots = 0;              ///< snapshots sent
  std::uint64_t snapshot_bytes = 0;         ///< bytes of the snapshots sent
  std::uint64_t skipped_ticks = 0;          ///< ticks after which a client was not up to date: unsent or
                                            ///< unacknowledged bytes, or an overloaded connection
  std::uint64_t ticks = 0;
  std::uint64_t late_ticks = 0;          ///< ticks that began more than 5 ms after their deadline
  std::uint64_t world_missed_ticks = 0;  ///< ticks missed by a world that had not finished the one before
  std::uint64_t rebased_ticks = 0;       ///< ticks that were a whole tick late: the schedule restarts
  // The part of snapshots and snapshot_bytes that was sent by datagram:
  std::uint64_t datagram_snapshots = 0;  ///< snapshots sent by datagram; the others used a stream
  std::uint64_t datagram_snapshot_bytes = 0;
  std::uint64_t inputs = 0;       ///< keys and clicks, without duplicates
  std::uint64_t late_inputs = 0;  ///< part of inputs: received after the tick they were meant for
  // Players who left, by reason:
  std::uint64_t left_voluntarily = 0;   ///< the client asked to leave
  std::uint64_t left_dismissed = 0;     ///< dismissed by the server: the game is over, or on request
  std::uint64_t left_disconnected = 0;  ///< the connection ended, and the grace time is 0
  std::uint64_t left_silent = 0;        ///< silent for too long
  std::uint64_t left_flood = 0;         ///< sent too much at once
  std::uint64_t left_malformed = 0;     ///< sent a malformed message
  std::uint64_t left_stalled = 0;       ///< read too slowly, or had more bytes queued than the host takes
  // Ends of world processes, by reason, without those that the server closed:
  std::uint64_t rounds_over = 0;
  std::uint64_t rounds_crashed = 0;
  std::uint64_t rounds_hung = 0;
  std::uint64_t rounds_broken = 0;
  std::uint64_t rounds_unrecovered = 0;
  std::uint64_t failovers_by_checkpoint = 0;  ///< worlds that failed and were replaced by a copy of them
  std::uint64_t failovers_by_replay = 0;
  // Scores added by games (HighScores.h):
  std::uint64_t scores = 0;          ///< accepted scores
  std::uint64_t scores_refused = 0;  ///< invalid scores, and scores for more tables than a game may have
  std::uint64_t scores_written = 0;  ///< scores on disk
  std::uint64_t scores_dropped = 0;  ///< not written: too many waited for the disk
  // Requests to the platform (HostPlatform.h) and messages between servers (Bus.h):
  std::uint64_t platform_requests = 0;  ///< requests that succeeded
  std::uint64_t platform_failures = 0;  ///< attempts that failed; retried
  std::uint64_t bus_published = 0;      ///< messages delivered
  std::uint64_t bus_dropped = 0;        ///< messages dropped because the queue was full, oldest first
  std::uint64_t bus_failures = 0;       ///< attempts that failed; retried
  std::uint64_t bus_connections = 0;    ///< connections made; more than one: the connection was lost
  std::uint64_t bus_lost = 0;           ///< messages to this server lost, because too many waited
  std::uint64_t audited_pictures = 0;   ///< player pictures compared with the world's (ReplicaAudit.h)
  std::uint64_t audited_cells = 0;      ///< cells of audited_pictures
  std::uint64_t wrong_cells = 0;        ///< audited_cells that differed

  /// Returns "connections=3 joined=2 …", without counters that are zero.
  std::string summary() const;
};

}  // namespace naiad
