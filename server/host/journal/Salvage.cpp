#include "host/journal/Salvage.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "host/journal/DfrReader.h"
#include "host/journal/DfrWriter.h"
#include "host/journal/TurnRing.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxSalvaged = std::uintmax_t{1} << 30;

std::string readFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Which round it is, by the header alone.
std::optional<DfrHeader> headerOf(const fs::path& path) {
  std::string bytes(kDfrHeaderSize, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return std::nullopt;
  const DfrReader reader(bytes);
  return reader.problem().empty() ? std::optional(reader.header()) : std::nullopt;
}

/// Bytes that were added; nothing if the file could not be written.
std::optional<std::size_t> complete(const fs::path& path, const LeftRing& ring) {
  const std::string bytes = readFile(path);
  DfrReader reader(bytes);
  while (reader.next()) continue;
  if (reader.end() == DfrEnd::kDone) return 0;
  const auto rest = ring.bytesFrom(reader.streamBytes());
  if (!rest) return 0;
  std::error_code error;
  const auto written_at = fs::last_write_time(path, error);
  fs::resize_file(path, reader.wholeBytes(), error);
  if (error) return std::nullopt;
  std::ofstream file(path, std::ios::binary | std::ios::app);
  file << spellDfrTurns(*rest, reader.streamBytes());
  file.close();
  fs::last_write_time(path, written_at, error);  // of the round, not of this
  return file.good() ? std::optional(rest->size()) : std::nullopt;
}

}  // namespace

std::vector<std::string> salvageRounds(const std::string& folder, const std::set<std::string>& left) {
  std::vector<std::string> said;
  std::set<std::string> rounds;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code ignored;
    const fs::path& path = entry.path();
    if (path.extension() != ".dfr" || !entry.is_regular_file(ignored)) continue;
    const auto header = headerOf(path);
    if (header) rounds.insert(uuidText(header->uuid));
    if (entry.file_size(ignored) > kMaxSalvaged) continue;
    const auto ring = header ? LeftRing::find(header->uuid) : std::nullopt;
    if (!ring) continue;
    const auto added = complete(path, *ring);
    if (!added) continue;  // the next start may do better
    ring->remove();
    if (left.contains(uuidText(header->uuid))) continue;
    said.push_back("the server was killed in the round " + path.string() +
                   ", which has all of its turns now");
  }
  removeStrayRings(ringFolder(folder), rounds);
  return said;
}

}  // namespace naiad
