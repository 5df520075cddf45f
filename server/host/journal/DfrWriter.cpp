#include "host/journal/DfrWriter.h"

#include <zstd.h>

#include <algorithm>
#include <array>

#include "shared/replica/Bytes.h"
#include "shared/values/LittleEndian.h"

namespace naiad {

namespace {

/// Level 6 packs a second of a game in some 100 µs. The window is the memory that a reader needs, too.
constexpr int kLevel = 6;
constexpr int kWindowLog = 18;

/// Bytes of records in one chunk: what does not shrink fits in a payload, too.
constexpr std::size_t kMaxPacked = kMaxDfrPayload / 2;

template <class Number>
void append(std::string& out, Number number) {
  std::array<char, sizeof(Number)> bytes{};
  storeLittleEndian(number, bytes.data());
  out.append(bytes.data(), bytes.size());
}

}  // namespace

std::string spellDfrHeader(const DfrHeader& header) {
  std::string rest;
  for (const std::uint8_t byte : header.uuid) rest.push_back(static_cast<char>(byte));
  append(rest, header.frame_nanos);
  append(rest, header.seed);
  append(rest, header.start_nanos);
  append(rest, std::uint64_t{0});
  std::string bytes(kDfrMagic);
  append(bytes, kDfrVersion);
  append(bytes, header.flags);
  append(bytes, crc32c(rest));
  return bytes + rest;
}

std::string spellDfrChunk(std::uint32_t type, std::string_view payload) {
  std::string head;
  append(head, type);
  append(head, static_cast<std::uint32_t>(payload.size()));
  std::string bytes = head;
  append(bytes, crc32c(payload, crc32c(head)));
  return bytes.append(payload);
}

std::string spellDfrMeta(const DfrFacts& facts) {
  std::string payload;
  ByteWriter out(payload);
  out.varint(std::min(facts.size(), kMaxDfrFacts));
  std::size_t count = 0;
  for (const auto& [name, value] : facts) {
    if (count++ == kMaxDfrFacts) break;
    for (const std::string_view part :
         {std::string_view(name).substr(0, kMaxDfrName), std::string_view(value).substr(0, kMaxDfrValue)}) {
      out.varint(part.size());
      out.bytes(part);
    }
  }
  return spellDfrChunk(kDfrMeta, std::string_view(payload).substr(0, kMaxDfrPayload));
}

std::string spellDfrDone(std::string_view why) {
  return spellDfrChunk(kDfrDone, why.substr(0, kMaxDfrValue));
}

std::string spellDfrTurns(std::string_view records, std::uint64_t position) {
  std::string chunks;
  while (!records.empty()) {
    const std::string_view part = records.substr(0, kMaxPacked);
    std::string payload;
    append(payload, static_cast<std::uint32_t>(position));
    payload.push_back(static_cast<char>(kDfrRaw));
    chunks += spellDfrChunk(kDfrTurn, payload.append(part));
    position += part.size();
    records.remove_prefix(part.size());
  }
  return chunks;
}

void DfrTurnPacker::Freer::operator()(void* p_context) const {
  ZSTD_freeCCtx(static_cast<ZSTD_CCtx*>(p_context));
}

DfrTurnPacker::DfrTurnPacker() : m_p_context(ZSTD_createCCtx()) {
  auto* p_context = static_cast<ZSTD_CCtx*>(m_p_context.get());
  if (p_context == nullptr) return;
  ZSTD_CCtx_setParameter(p_context, ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(p_context, ZSTD_c_windowLog, kWindowLog);
}

DfrTurnPacker::~DfrTurnPacker() = default;

std::string DfrTurnPacker::pack(std::string_view records) {
  std::string chunks;
  for (; !records.empty(); records.remove_prefix(std::min(records.size(), kMaxPacked)))
    chunks += packOne(records.substr(0, kMaxPacked));
  return chunks;
}

std::string DfrTurnPacker::packOne(std::string_view records) {
  std::string payload;
  append(payload, static_cast<std::uint32_t>(m_offset));
  m_offset += records.size();
  auto* p_context = static_cast<ZSTD_CCtx*>(m_p_context.get());
  payload.push_back(static_cast<char>(p_context != nullptr ? kDfrZstd : kDfrRaw));
  if (p_context == nullptr) return spellDfrChunk(kDfrTurn, payload.append(records));
  const std::size_t head = payload.size();
  // Room for all that a flush gives out, so that one call does it.
  payload.resize(head + ZSTD_compressBound(records.size()) + ZSTD_CStreamOutSize());
  ZSTD_inBuffer from{records.data(), records.size(), 0};
  ZSTD_outBuffer to{payload.data(), payload.size(), head};
  const std::size_t left = ZSTD_compressStream2(p_context, &to, &from, ZSTD_e_flush);
  if (ZSTD_isError(left) != 0 || left != 0) {
    // A reader ends its frame where raw records begin; the next begins a frame of its own.
    ZSTD_CCtx_reset(p_context, ZSTD_reset_session_only);
    payload.resize(head);
    payload.back() = static_cast<char>(kDfrRaw);
    return spellDfrChunk(kDfrTurn, payload.append(records));
  }
  payload.resize(to.pos);
  return spellDfrChunk(kDfrTurn, payload);
}

}  // namespace naiad
