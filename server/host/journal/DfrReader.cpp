#include "host/journal/DfrReader.h"

#include <algorithm>

#include "shared/net/base/SafeText.h"
#include "shared/replica/Bytes.h"
#include "shared/values/LittleEndian.h"

namespace naiad {

namespace {

/// Limit of unpacked bytes per byte of the file. Turns unpack to about 4 times their size, without players to
/// 10 times; a file that promises more would take more time than its size suggests.
constexpr std::uint64_t kMaxRatio = 64;

}  // namespace

DfrReader::DfrReader(std::string_view bytes) : m_bytes(bytes) {
  readHeader();
  if (!m_problem.empty()) {
    m_ended = true;
    m_end = DfrEnd::kDamaged;
    return;
  }
  // Reads the facts before the first turn.
  while (!m_ended && m_records.atEnd()) {
    m_whole_records = m_at;
    readChunk();
  }
}

void DfrReader::readHeader() {
  if (m_bytes.substr(0, kDfrMagic.size()) != kDfrMagic) {
    m_problem = "not a round recording";
    return;
  }
  if (m_bytes.size() < kDfrHeaderSize) {
    m_problem = "truncated before the first chunk";
    return;
  }
  const char* p = m_bytes.data();
  if (const auto version = loadLittleEndian<std::uint16_t>(p + 8); version != kDfrVersion) {
    m_problem = "format version " + std::to_string(version) + ", but this program reads version " +
                std::to_string(kDfrVersion);
    return;
  }
  m_header.flags = loadLittleEndian<std::uint16_t>(p + kDfrFlagsAt);
  if (loadLittleEndian<std::uint32_t>(p + 12) != crc32c(m_bytes.substr(16, kDfrHeaderSize - 16))) {
    m_problem = "damaged header";
    return;
  }
  std::copy_n(p + 16, m_header.uuid.size(), m_header.uuid.begin());
  m_header.frame_nanos = loadLittleEndian<std::uint64_t>(p + 32);
  m_header.seed = loadLittleEndian<std::uint64_t>(p + 40);
  m_header.start_nanos = loadLittleEndian<std::uint64_t>(p + 48);
  m_at = kDfrHeaderSize;
}

// The constructor may have read the first chunk of records, while it looked for facts.
void DfrReader::copyRecordsTo(std::string& records) {
  m_p_copy = &records;
  if (m_offset > 0) records = m_unpacked;
}

std::optional<TurnRecord> DfrReader::next() {
  while (true) {
    if (auto record = m_records.next()) return record;
    if (m_records.isBad()) {
      m_ended = true;
      m_end = DfrEnd::kDamaged;
    }
    if (m_records.atEnd()) m_whole_records = m_at;
    if (m_ended || !readChunk()) return std::nullopt;
  }
}

// Unpacking takes most of the time that a long file needs, so it is skipped.
void DfrReader::skipToEnd() {
  m_skips = true;
  m_records = {};
  while (!m_ended) readChunk();
}

bool DfrReader::readChunk() {
  const auto chunk = nextChunk();
  if (chunk && !handleChunk(*chunk)) m_end = DfrEnd::kDamaged;
  m_ended = m_ended || !chunk || m_end == DfrEnd::kDamaged;
  return !m_ended;
}

std::optional<DfrReader::Chunk> DfrReader::nextChunk() {
  const std::string_view rest = m_bytes.substr(m_at);
  if (rest.size() < kDfrChunkHead) return std::nullopt;
  const auto size = loadLittleEndian<std::uint32_t>(rest.data() + 4);
  if (size > kMaxDfrPayload) {
    m_end = DfrEnd::kDamaged;
    return std::nullopt;
  }
  if (rest.size() - kDfrChunkHead < size) return std::nullopt;
  const std::string_view payload = rest.substr(kDfrChunkHead, size);
  if (loadLittleEndian<std::uint32_t>(rest.data() + 8) != crc32c(payload, crc32c(rest.substr(0, 8)))) {
    // Blocks that were not written before a power cut read as zeros.
    const bool zeros = rest.find_first_not_of('\0') == std::string_view::npos;
    m_end = zeros ? DfrEnd::kTorn : DfrEnd::kDamaged;
    return std::nullopt;
  }
  m_at += kDfrChunkHead + size;
  return Chunk{loadLittleEndian<std::uint32_t>(rest.data()), payload};
}

bool DfrReader::handleChunk(const Chunk& chunk) {
  if (chunk.type == kDfrMeta) return readMeta(chunk.payload);
  if (chunk.type == kDfrTurn) return readTurns(chunk.payload);
  if (chunk.type != kDfrDone) return true;
  m_ended = true;
  m_end = DfrEnd::kDone;
  m_end_reason = safeText(std::string(chunk.payload.substr(0, kMaxDfrName)), kMaxDfrName);
  return true;
}

bool DfrReader::readMeta(std::string_view payload) {
  ByteReader in(payload);
  const std::uint64_t count = in.upTo(kMaxDfrFacts);
  for (std::uint64_t i = 0; i < count && in.ok(); ++i) {
    const std::string_view name = in.bytes(in.upTo(kMaxDfrName));
    const std::string_view value = in.bytes(in.upTo(kMaxDfrValue));
    if (m_facts.size() < kMaxDfrFacts && in.ok()) m_facts[std::string(name)] = value;
  }
  return in.ok() && in.atEnd();
}

bool DfrReader::readTurns(std::string_view payload) {
  if (payload.size() < kDfrTurnPositionSize) return false;
  if (loadLittleEndian<std::uint16_t>(payload.data()) != static_cast<std::uint16_t>(m_offset)) return false;
  ByteReader head(payload.substr(kDfrTurnPositionSize));
  const std::uint64_t what = head.upTo(2 * kMaxDfrPayload + 1);
  if (!head.ok()) return false;
  const auto packing = static_cast<DfrPacking>(what & 1);
  const std::uint64_t count = what >> 1;
  const std::string_view packed = head.rest();
  m_offset += count;
  if (m_offset > kMaxRatio * m_bytes.size() + kMaxDfrPayload) return false;
  m_unpacked.clear();
  if (packing == kDfrRaw && packed.size() != count) return false;
  if (m_skips) return true;
  if (packing == kDfrRaw) {
    m_unpacked = packed;
  } else {
    m_unpacker.unpack(packed, count, m_unpacked);
  }
  m_records.add(m_unpacked);
  if (m_p_copy != nullptr) m_p_copy->append(m_unpacked);
  return true;
}

}  // namespace naiad
