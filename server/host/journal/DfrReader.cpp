#include "host/journal/DfrReader.h"

#include <zstd.h>

#include <algorithm>

#include "shared/net/base/SafeText.h"
#include "shared/replica/Bytes.h"
#include "shared/values/LittleEndian.h"

namespace naiad {

namespace {

/// Of a frame, at most: what the writer takes, and some room for later ones.
constexpr int kMaxWindowLog = 20;

/// Turns are some ten times as long as in the file, and hundreds of times if nobody plays. A file that
/// promises more would cost more time than its size says.
constexpr std::uint64_t kMaxRatio = 1000;

}  // namespace

DfrReader::DfrReader(std::string_view bytes) : m_bytes(bytes) {
  readHeader();
  if (!m_problem.empty()) {
    m_ended = true;
    m_end = DfrEnd::kDamaged;
    return;
  }
  // So that facts are there before the first turn is asked for.
  while (!m_ended && m_records.atEnd() && readChunk()) continue;
}

DfrReader::~DfrReader() = default;

void DfrReader::Freer::operator()(void* p_context) const {
  ZSTD_freeDCtx(static_cast<ZSTD_DCtx*>(p_context));
}

void DfrReader::readHeader() {
  if (m_bytes.substr(0, kDfrMagic.size()) != kDfrMagic) {
    m_problem = "it is no recording of a round";
    return;
  }
  if (m_bytes.size() < kDfrHeaderSize) {
    m_problem = "it is cut off before the first chunk";
    return;
  }
  const char* p = m_bytes.data();
  if (const auto version = loadLittleEndian<std::uint16_t>(p + 8); version != kDfrVersion) {
    m_problem = "its format is version " + std::to_string(version) + ", and this program reads version " +
                std::to_string(kDfrVersion);
    return;
  }
  m_header.flags = loadLittleEndian<std::uint16_t>(p + kDfrFlagsAt);
  if (loadLittleEndian<std::uint32_t>(p + 12) != crc32c(m_bytes.substr(16, kDfrHeaderSize - 16))) {
    m_problem = "its header is damaged";
    return;
  }
  std::copy_n(p + 16, m_header.uuid.size(), m_header.uuid.begin());
  m_header.frame_nanos = loadLittleEndian<std::uint64_t>(p + 32);
  m_header.seed = loadLittleEndian<std::uint64_t>(p + 40);
  m_header.start_nanos = loadLittleEndian<std::uint64_t>(p + 48);
  m_at = kDfrHeaderSize;
}

std::optional<TurnRecord> DfrReader::next() {
  while (true) {
    if (auto record = m_records.next()) return record;
    if (m_records.isBad()) {
      m_ended = true;
      m_end = DfrEnd::kDamaged;
    }
    if (m_ended || !readChunk()) return std::nullopt;
  }
}

bool DfrReader::readChunk() {
  const auto chunk = nextChunk();
  if (chunk && !takeChunk(*chunk)) m_end = DfrEnd::kDamaged;
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
    // Blocks of a file that were never written, before a power cut, read as zeros.
    const bool zeros = rest.find_first_not_of('\0') == std::string_view::npos;
    m_end = zeros ? DfrEnd::kTorn : DfrEnd::kDamaged;
    return std::nullopt;
  }
  m_at += kDfrChunkHead + size;
  return Chunk{loadLittleEndian<std::uint32_t>(rest.data()), payload};
}

bool DfrReader::takeChunk(const Chunk& chunk) {
  if (chunk.type == kDfrMeta) return readMeta(chunk.payload);
  if (chunk.type == kDfrTurn) return readTurns(chunk.payload);
  if (chunk.type != kDfrDone) return true;
  m_ended = true;
  m_end = DfrEnd::kDone;
  m_why = safeText(std::string(chunk.payload.substr(0, kMaxDfrName)), kMaxDfrName);
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
  if (payload.size() < kDfrTurnHead) return false;
  if (loadLittleEndian<std::uint32_t>(payload.data()) != static_cast<std::uint32_t>(m_offset)) return false;
  const auto packing = static_cast<std::uint8_t>(payload[kDfrTurnHead - 1]);
  const std::string_view packed = payload.substr(kDfrTurnHead);
  m_unpacked.clear();
  if (packing == kDfrRaw) {
    m_p_context.reset();
    m_unpacked = packed;
  } else if (packing != kDfrZstd || !unpack(packed)) {
    return false;
  }
  m_offset += m_unpacked.size();
  if (m_offset > kMaxRatio * m_bytes.size() + kMaxDfrPayload) return false;
  m_records.add(m_unpacked);
  return true;
}

bool DfrReader::unpack(std::string_view packed) {
  if (m_p_context == nullptr) {
    m_p_context.reset(ZSTD_createDCtx());
    if (m_p_context == nullptr) return false;
    ZSTD_DCtx_setParameter(static_cast<ZSTD_DCtx*>(m_p_context.get()), ZSTD_d_windowLogMax, kMaxWindowLog);
  }
  auto* p_context = static_cast<ZSTD_DCtx*>(m_p_context.get());
  m_unpacked.resize(kMaxDfrPayload);
  ZSTD_inBuffer from{packed.data(), packed.size(), 0};
  ZSTD_outBuffer to{m_unpacked.data(), m_unpacked.size(), 0};
  while (from.pos < from.size) {
    const std::size_t before = from.pos + to.pos;
    const std::size_t left = ZSTD_decompressStream(p_context, &to, &from);
    if (ZSTD_isError(left) != 0 || from.pos + to.pos == before || to.pos == to.size) return false;
  }
  m_unpacked.resize(to.pos);
  return true;
}

}  // namespace naiad
