#include "host/journal/Salvage.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "host/journal/DfrReader.h"
#include "host/journal/DfrWriter.h"
#include "host/journal/JournalSink.h"
#include "host/journal/TurnRing.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

/// Returns the header of a file; nullopt if the file is not trusted or does not begin with a valid one.
std::optional<DfrHeader> headerOf(const fs::path& path) try {
  const std::string bytes = readTrustedStart(path, kDfrHeaderSize);
  const DfrReader reader(bytes);
  return reader.problem().empty() ? std::optional(reader.header()) : std::nullopt;
} catch (const std::system_error&) {
  return std::nullopt;
}

/// Appends the missing records. Returns what happened to the round's last turns, for the log; nullopt if the
/// file could not be read or written.
std::optional<std::string> complete(const fs::path& path, const OrphanedRing& ring) try {
  const std::string bytes = readTrusted(path, kMaxRoundFile).value_or("");
  DfrReader reader(bytes);
  reader.skipToEnd();
  if (reader.end() == DfrEnd::kDone) return "the file has all turns";
  const auto rest = ring.bytesFrom(reader.streamBytes());
  if (!rest) return "turns are lost, because the file is shorter than it was";
  std::error_code error;
  const auto written_at = fs::last_write_time(path, error);
  JournalFileSink file(path.string(), reader.wholeBytes());
  file.write(encodeDfrTurns(*rest, reader.streamBytes()));
  fs::last_write_time(path, written_at, error);  // keep the round's time
  return "its last turns were added from memory";
} catch (const std::system_error&) {
  return std::nullopt;
}

/// True for a valid file name of a round, without a folder.
bool isNameOfRound(const std::string& name) {
  return name.size() > std::size(".dfr") && name.ends_with(".dfr") && name.front() != '.' &&
         name.find('/') == std::string::npos;
}

/// The rounds in a folder.
struct Rounds {
  std::set<std::string> uuids;
  std::vector<std::pair<fs::path, DfrHeader>> files;
};

Rounds roundsIn(const fs::path& folder) {
  Rounds rounds;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code ignored;
    if (entry.path().extension() != ".dfr" || !entry.is_regular_file(ignored)) continue;
    const auto header = headerOf(entry.path());
    if (!header) continue;
    rounds.uuids.insert(uuidText(header->uuid));
    rounds.files.emplace_back(entry.path(), *header);
  }
  return rounds;
}

/// Creates the round files that killed servers had not created yet. Existing rounds are left alone. Adds a
/// line to `said` for each file that cannot be created.
void beginFiles(const fs::path& folder, std::vector<std::string>& said) {
  for (const OrphanedRing& ring : OrphanedRing::findWithoutFile(ringFolder(folder), roundsIn(folder).uuids)) {
    const auto beginning = ring.beginning();
    if (!beginning || !isNameOfRound(beginning->name)) continue;
    const fs::path path = folder / beginning->name;
    std::error_code error;
    if (fs::is_regular_file(path, error) && !headerOf(path))
      fs::remove(path, error);  // its creation was not finished
    try {
      JournalFileSink file(path.string());
      file.write(beginning->bytes);
      file.sync();
    } catch (const std::system_error& error_of_file) {
      said.push_back(std::string("a killed server's round cannot be saved: ") + error_of_file.what());
      continue;
    }
    if (const auto time = fs::last_write_time(ring.path(), error); !error)
      fs::last_write_time(path, time, error);  // keep the round's time
  }
}

}  // namespace

std::vector<std::string> salvageRounds(const std::string& folder, const std::set<std::string>& left) {
  std::vector<std::string> said;
  beginFiles(folder, said);
  const Rounds rounds = roundsIn(folder);
  for (const auto& [path, header] : rounds.files) {
    const auto ring = OrphanedRing::find(header.uuid);
    if (!ring) continue;
    const auto result = complete(path, *ring);
    if (!result) continue;  // retried at the next start
    ring->remove();
    if (left.contains(uuidText(header.uuid))) continue;
    said.push_back("the previous server was killed in the round " + path.string() + "; " + *result);
  }
  removeStrayRings(ringFolder(folder), rounds.uuids);
  return said;
}

}  // namespace naiad
