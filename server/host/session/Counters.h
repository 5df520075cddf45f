// What the host counts: every rejection has a number, so that nothing is dropped in silence.
#pragma once

#include <cstdint>
#include <string>

namespace naiad {

struct Counters {
  std::uint64_t connections = 0;         ///< accepted by the listener
  std::uint64_t joined = 0;              ///< welcomed
  std::uint64_t turned_away = 0;         ///< closed without an answer: too many connections
  std::uint64_t refused_version = 0;     ///< wrong protocol version
  std::uint64_t refused_full = 0;        ///< no place left
  std::uint64_t refused_address = 0;     ///< too many players from one address
  std::uint64_t refused_closing = 0;     ///< the server is about to end
  std::uint64_t refused_game = 0;        ///< asked for another game
  std::uint64_t refused_name = 0;        ///< no usable name
  std::uint64_t malformed_frames = 0;    ///< oversized or empty frames: the connection ended
  std::uint64_t malformed_messages = 0;  ///< bytes that are no message, or a value out of range: ended
  std::uint64_t login_timeouts = 0;      ///< no hello, or no judgement of it, in time: ended
  std::uint64_t idle_timeouts = 0;       ///< silent too long: ended
  std::uint64_t input_floods = 0;        ///< more inputs queued than allowed: ended
  std::uint64_t message_floods = 0;      ///< more messages between two ticks than allowed: ended
  std::uint64_t detached = 0;            ///< streams that broke while their session goes on
  std::uint64_t resumed = 0;             ///< sessions that went on with another stream
  std::uint64_t restarted = 0;           ///< of these: with another process of the client
  std::uint64_t restored = 0;            ///< sessions of a server that was killed
  std::uint64_t returned = 0;            ///< clients that came back to these
  std::uint64_t second_streams = 0;      ///< beside the first, where datagrams do not pass
  std::uint64_t resumes_deferred = 0;    ///< came back more often than allowed: refused for now
  std::uint64_t seconds_deferred = 0;    ///< second streams more often than allowed: refused for now
  std::uint64_t sent_on = 0;             ///< refused_full or closing, with a link to another server
  std::uint64_t refused_elsewhere = 0;   ///< came back, but the session goes on in another process
  std::uint64_t unknown_tokens =
      0;  ///< of no session that is still there: a new player, or a guess, or no place for a second stream
  std::uint64_t kept_overflows = 0;     ///< sounds left out, since too much was kept for a client
  std::uint64_t chat_left_out = 0;      ///< lines, for the same reason, each counted for each client
  std::uint64_t repeated_frames = 0;    ///< kept frames that had come already: ignored
  std::uint64_t stuck_streams = 0;      ///< not taken in for 10 s: ended
  std::uint64_t graces_expired = 0;     ///< clients that did not come back in time
  std::uint64_t refused_password = 0;   ///< missing or wrong
  std::uint64_t refused_banned = 0;     ///< a ban of their name, or one made while they connected
  std::uint64_t refused_busy = 0;       ///< for now: passwords wait, too many joined, no world can begin
  std::uint64_t divergences = 0;        ///< a client's world was not what it was sent: reset
  std::uint64_t resets = 0;             ///< worlds sent again, on request or after a divergence
  std::uint64_t resets_dropped = 0;     ///< sooner than two seconds after the last one: ignored
  std::uint64_t checksums_dropped = 0;  ///< more often than four a second, or on two streams: ignored
  std::uint64_t repeated_inputs = 0;    ///< applied before: ignored
  std::uint64_t chat_dropped = 0;       ///< faster than three lines a second, or than an address may: ignored
  std::uint64_t chat_muted = 0;         ///< lines of muted players: sent to nobody
  std::uint64_t room_moves = 0;         ///< players who went to another room
  std::uint64_t room_moves_refused = 0;     ///< that is not there, is full, or cannot begin
  std::uint64_t room_requests_dropped = 0;  ///< for the list of rooms or another room, too often: ignored
  std::uint64_t refused_room = 0;           ///< no such room
  std::uint64_t inactive = 0;               ///< no key, click or line for too long: ended
  std::uint64_t sounds = 0;                 ///< sent, each counted for each player
  std::uint64_t sounds_dropped = 0;         ///< too many, or the stream was broken or busy: not sent
  std::uint64_t resizes_deferred = 0;       ///< replaced by a newer one before they were taken over
  std::uint64_t snapshots = 0;              ///< sent
  std::uint64_t snapshot_bytes = 0;         ///< of their frames
  std::uint64_t skipped_ticks =
      0;  ///< a client with unsent or unacknowledged bytes, or on a full line, was not brought up to date
  std::uint64_t ticks = 0;
  std::uint64_t late_ticks = 0;     ///< began more than 5 ms after their deadline
  std::uint64_t late_worlds = 0;    ///< ticks that began while a world's process was not ready for one
  std::uint64_t rebased_ticks = 0;  ///< a whole tick late: the schedule starts again
  // Of snapshots and their bytes:
  std::uint64_t datagram_snapshots = 0;  ///< sent by datagram, the others on a stream
  std::uint64_t datagram_snapshot_bytes = 0;
  std::uint64_t inputs = 0;       ///< keys and clicks, each once
  std::uint64_t late_inputs = 0;  ///< of these: after the tick in which they were to be applied
  // Players who left, by why:
  std::uint64_t left_asked = 0;      ///< their client said so
  std::uint64_t left_dismissed = 0;  ///< by the server: the game is over, or on request
  std::uint64_t left_hung_up = 0;    ///< the connection ended, and there is no grace
  std::uint64_t left_silent = 0;     ///< for too long
  std::uint64_t left_flood = 0;      ///< sent too much at once
  std::uint64_t left_malformed = 0;  ///< sent what no client sends
  std::uint64_t left_stuck = 0;      ///< took in too little
  // Worlds in processes of their own, by how they ended; without those that were closed:
  std::uint64_t rounds_over = 0;
  std::uint64_t rounds_crashed = 0;
  std::uint64_t rounds_hung = 0;
  std::uint64_t rounds_broken = 0;
  std::uint64_t rounds_unrecovered = 0;
  std::uint64_t taken_over_by_copies = 0;  ///< worlds that died, and that their round went on without
  std::uint64_t taken_over_by_worlds = 0;
  // Scores that games added (HighScores.h):
  std::uint64_t scores = 0;          ///< taken over
  std::uint64_t scores_refused = 0;  ///< no good, or of more tables than a game may have
  std::uint64_t scores_written = 0;  ///< on disk
  std::uint64_t scores_dropped = 0;  ///< in memory alone: too many waited for the disk
  // What runs the server (HostPlatform.h), and what servers say to each other (Bus.h):
  std::uint64_t platform_requests = 0;  ///< answered well
  std::uint64_t platform_failures = 0;  ///< not; tried again
  std::uint64_t bus_published = 0;      ///< messages that arrived
  std::uint64_t bus_dropped = 0;        ///< the oldest of too many that waited
  std::uint64_t bus_failures = 0;       ///< tried again
  std::uint64_t bus_connections = 0;    ///< more than one: it was lost and came back
  std::uint64_t audited_pictures = 0;   ///< of players, held against the world's (PictureAudit.h)
  std::uint64_t audited_cells = 0;      ///< of these
  std::uint64_t wrong_cells = 0;        ///< of these

  /// "connections=3 joined=2 …", only what is not zero.
  std::string summary() const;
};

}  // namespace naiad
