// dfreplay --verify, --inputs, --scores and --text: checks and prints recorded rounds.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace naiad {

class RecordedRound;
class ReplayEnvironment;

/// Replays the round, and prints the result. Returns true if it matches the file up to the last whole turn.
bool verifyRound(const RecordedRound& round, const ReplayEnvironment& environment, std::ostream& out);

/// Prints one line for each input, one where the host ends the game, and a last one with the number of ticks.
void printInputs(const RecordedRound& round, std::ostream& out);

/// Replays the round, and prints one line for each score that the game adds: "tick=N number=N table=…
/// name="…" points=N"; tick and number identify its row in the server's file of scores. Returns false if the
/// round differs from the file; then the last line names the first tick that differs.
bool printScores(const RecordedRound& round, const ReplayEnvironment& environment, std::ostream& out);

/// Prints a player's picture after this tick; player 0: the first one. Returns false if the round has no such
/// tick, or there is no such player.
bool printPicture(const RecordedRound& round, const ReplayEnvironment& environment, std::uint32_t tick,
                  std::uint32_t player, std::ostream& out);

}  // namespace naiad
