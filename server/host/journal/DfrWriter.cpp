#include "host/journal/DfrWriter.h"

#include <algorithm>
#include <array>

#include "shared/replica/Bytes.h"
#include "shared/values/LittleEndian.h"

namespace naiad {

namespace {

/// Maximum size of the records in one chunk, in bytes. Even if packing enlarges them, they fit in a payload.
constexpr std::size_t kMaxPacked = kMaxDfrPayload / 2;

template <class Number>
void append(std::string& out, Number number) {
  std::array<char, sizeof(Number)> bytes{};
  storeLittleEndian(number, bytes.data());
  out.append(bytes.data(), bytes.size());
}

std::string turnHead(std::uint64_t position, DfrPacking packing, std::size_t count) {
  std::string head;
  append(head, static_cast<std::uint16_t>(position));
  ByteWriter(head).varint(count << 1 | packing);
  return head;
}

}  // namespace

std::string encodeDfrHeader(const DfrHeader& header) {
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

std::string encodeDfrChunk(std::uint32_t type, std::string_view payload) {
  std::string head;
  append(head, type);
  append(head, static_cast<std::uint32_t>(payload.size()));
  std::string bytes = head;
  append(bytes, crc32c(payload, crc32c(head)));
  return bytes.append(payload);
}

std::string encodeDfrMeta(const DfrFacts& facts) {
  std::string entries;
  ByteWriter out(entries);
  std::size_t count = 0;
  for (const auto& [name, value] : facts) {
    constexpr std::size_t kMaxEntry = kMaxDfrName + kMaxDfrValue + 16;  // with the sizes, and `count`
    if (count == kMaxDfrFacts || entries.size() + kMaxEntry > kMaxDfrPayload) break;
    ++count;
    for (const std::string_view part :
         {std::string_view(name).substr(0, kMaxDfrName), std::string_view(value).substr(0, kMaxDfrValue)}) {
      out.varint(part.size());
      out.bytes(part);
    }
  }
  std::string payload;
  ByteWriter(payload).varint(count);
  return encodeDfrChunk(kDfrMeta, payload + entries);
}

std::string encodeDfrDone(std::string_view why) {
  return encodeDfrChunk(kDfrDone, why.substr(0, kMaxDfrValue));
}

std::string encodeDfrTurns(std::string_view records, std::uint64_t position) {
  std::string chunks;
  while (!records.empty()) {
    const std::string_view part = records.substr(0, kMaxPacked);
    chunks += encodeDfrChunk(kDfrTurn, turnHead(position, kDfrRaw, part.size()).append(part));
    position += part.size();
    records.remove_prefix(part.size());
  }
  return chunks;
}

std::string DfrTurnPacker::pack(std::string_view records) {
  std::string chunks;
  while (!records.empty()) {
    const std::string_view part = records.substr(0, kMaxPacked);
    std::string payload = turnHead(m_position, kDfrModelled, part.size());
    m_packer.pack(part, payload);
    chunks += encodeDfrChunk(kDfrTurn, payload);
    m_position += part.size();
    records.remove_prefix(part.size());
  }
  return chunks;
}

}  // namespace naiad
