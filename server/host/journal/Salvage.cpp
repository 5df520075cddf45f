#include "host/journal/Salvage.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>

#include "host/journal/DfrReader.h"
#include "host/journal/DfrWriter.h"
#include "host/journal/JournalSink.h"
#include "host/journal/TurnRing.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxSalvaged = std::uintmax_t{1} << 30;

std::string readFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the header of a file; nullopt if it does not begin with a valid one.
std::optional<DfrHeader> headerOf(const fs::path& path) {
  std::string bytes(kDfrHeaderSize, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return std::nullopt;
  const DfrReader reader(bytes);
  return reader.problem().empty() ? std::optional(reader.header()) : std::nullopt;
}

/// Appends the missing records. Returns the bytes added; nullopt if the file could not be written.
std::optional<std::size_t> complete(const fs::path& path, const OrphanedRing& ring) {
  const std::string bytes = readFile(path);
  DfrReader reader(bytes);
  reader.skipToEnd();
  if (reader.end() == DfrEnd::kDone) return 0;
  const auto rest = ring.bytesFrom(reader.streamBytes());
  if (!rest) return 0;
  std::error_code error;
  const auto written_at = fs::last_write_time(path, error);
  fs::resize_file(path, reader.wholeBytes(), error);
  if (error) return std::nullopt;
  std::ofstream file(path, std::ios::binary | std::ios::app);
  file << encodeDfrTurns(*rest, reader.streamBytes());
  file.close();
  fs::last_write_time(path, written_at, error);  // keep the round's time
  return file.good() ? std::optional(rest->size()) : std::nullopt;
}

/// True for a valid file name of a round, without a folder.
bool isNameOfRound(const std::string& name) {
  return name.size() > std::size(".dfr") && name.ends_with(".dfr") && name.front() != '.' &&
         name.find('/') == std::string::npos;
}

/// Creates the round files that killed servers had not created yet. Existing rounds are left alone.
void beginFiles(const fs::path& folder, const std::set<std::string>& rounds) {
  for (const OrphanedRing& ring : OrphanedRing::findWithoutFile(ringFolder(folder), rounds)) {
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
    } catch (const std::system_error&) {
      continue;  // the disk is full, or another server created the file
    }
    if (const auto time = fs::last_write_time(ring.path(), error); !error)
      fs::last_write_time(path, time, error);  // keep the round's time
  }
}

/// Returns the uuids of the rounds in a folder.
std::set<std::string> roundsIn(const fs::path& folder) {
  std::set<std::string> rounds;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code ignored;
    if (entry.path().extension() != ".dfr" || !entry.is_regular_file(ignored)) continue;
    if (const auto header = headerOf(entry.path())) rounds.insert(uuidText(header->uuid));
  }
  return rounds;
}

}  // namespace

std::vector<std::string> salvageRounds(const std::string& folder, const std::set<std::string>& left) {
  std::vector<std::string> said;
  beginFiles(folder, roundsIn(folder));
  std::set<std::string> rounds;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code ignored;
    const fs::path& path = entry.path();
    if (path.extension() != ".dfr" || !entry.is_regular_file(ignored)) continue;
    const auto header = headerOf(path);
    if (header) rounds.insert(uuidText(header->uuid));
    if (entry.file_size(ignored) > kMaxSalvaged) continue;
    const auto ring = header ? OrphanedRing::find(header->uuid) : std::nullopt;
    if (!ring) continue;
    const auto added = complete(path, *ring);
    if (!added) continue;  // retried at the next start
    ring->remove();
    if (left.contains(uuidText(header->uuid))) continue;
    said.push_back("the previous server was killed in the round " + path.string() +
                   "; its last turns were added from memory");
  }
  removeStrayRings(ringFolder(folder), rounds);
  return said;
}

}  // namespace naiad
