// dfreplay --verify: is the round the same when it is executed again?
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace naiad {

class RecordedRound;
class RoundStage;

/// Print it; true: it is, to the last whole turn of the file.
bool verifyRound(const RecordedRound& round, const RoundStage& stage, std::ostream& out);

/// One line for each input and each tick's end that is worth one.
void printInputs(const RecordedRound& round, std::ostream& out);

/// Execute it, and print one line for each score that the game adds: "tick=N number=N table=… name="…"
/// points=N", which name its row in the server's file of scores. False: the round is not the same any more,
/// and the last line says from which tick on.
bool printScores(const RecordedRound& round, const RoundStage& stage, std::ostream& out);

/// What a player sees after this tick; 0: the first of them. False: the round has no such tick, or no player
/// to see it.
bool printPicture(const RecordedRound& round, const RoundStage& stage, std::uint32_t tick,
                  std::uint32_t player, std::ostream& out);

}  // namespace naiad
