#include "tests/proto/RandomFields.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace naiad::test {
namespace {

/// Texts near the limits of valid UTF-8.
constexpr std::array<std::string_view, 14> kTexts = {"\x7F",
                                                     "\x80",
                                                     "\xC1\xBF",
                                                     "\xC2\x80",
                                                     "\xE0\x9F\xBF",
                                                     "\xE0\xA0\x80",
                                                     "\xED\x9F\xBF",
                                                     "\xED\xA0\x80",
                                                     "\xEE\x80\x80",
                                                     "\xF0\x8F\xBF\xBF",
                                                     "\xF4\x8F\xBF\xBF",
                                                     "\xF4\x90\x80\x80",
                                                     "\xE2\x82",
                                                     "\xFF"};

std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<char>(value | 0x80));
  bytes.push_back(static_cast<char>(value));
  return bytes;
}

/// Encodes the number in more bytes than needed. A number may have ten, a key or a length five.
std::string longVarint(RandomFields& random, std::uint64_t value) {
  std::string bytes = varint(value);
  for (std::uint64_t more = random.below(12); more > 0; --more) {
    bytes.back() = static_cast<char>(bytes.back() | 0x80);
    bytes.push_back(more == 1 && random.below(4) == 0 ? '\x7F' : '\0');
  }
  return bytes;
}

std::string anyVarint(RandomFields& random, std::uint64_t value) {
  return random.below(8) == 0 ? longVarint(random, value) : varint(value);
}

std::string key(RandomFields& random, std::uint64_t wire) {
  const std::uint64_t number = random.below(16) == 0 ? random.number() : random.below(24);
  return anyVarint(random, (number << 3) | wire);
}

std::string sized(RandomFields& random, const std::string& bytes) {
  const std::uint64_t kind = random.below(16);
  const std::uint64_t size = kind == 0   ? random.number()
                             : kind == 1 ? random.below(bytes.size() + 3)
                                         : bytes.size();
  return anyVarint(random, size) + bytes;
}

std::string randomField(RandomFields& random, int depth) {
  const std::uint64_t wire =
      random.below(24) == 0 ? random.below(8) : std::array{0, 1, 2, 2, 2, 2, 3, 5}[random.below(8)];
  const std::string head = key(random, wire);
  switch (wire) {
    case 0:
      return head + anyVarint(random, random.number());
    case 1:
      return head + std::string(8, static_cast<char>(random.below(256)));
    case 5:
      return head + std::string(4, static_cast<char>(random.below(256)));
    case 2:
      if (depth > 0 && random.flag()) return head + sized(random, randomFields(random, depth - 1));
      return head +
             sized(random, random.flag() ? random.text() : std::string(kTexts[random.below(kTexts.size())]));
    case 3: {
      std::string end = head;  // the key with another wire type
      end.front() = static_cast<char>(end.front() ^ 7);
      if (random.below(8) == 0) end = key(random, 4);
      return head + (depth > 0 ? randomFields(random, depth - 1) : "") + end;
    }
    default:
      return head;
  }
}

}  // namespace

std::uint64_t RandomFields::number() {
  const std::uint64_t bits = m_random.next();
  const std::uint64_t value = bits >> below(64);
  if (below(8) == 0) return bits << below(64);  // the low bits are 0
  return below(8) == 0 ? ~value : value;
}

std::size_t RandomFields::length() {
  constexpr std::array<std::size_t, 4> kSteps = {126, 127, 128, 300};  // near a length of two bytes
  return below(32) == 0 ? kSteps[below(kSteps.size())] : below(12);
}

std::string RandomFields::text() {
  std::string text;
  for (std::size_t left = length(); left > 0; --left) {
    const std::uint64_t kind = below(8);
    if (kind == 0) {
      text += std::array{"\xC3\xA9", "\xE2\x82\xAC", "\xF0\x9F\x98\x80"}[below(3)];
    } else {
      text.push_back(static_cast<char>(below(128)));
    }
  }
  return text;
}

std::string RandomFields::bytes() {
  std::string bytes(length(), '\0');
  for (char& byte : bytes) byte = static_cast<char>(below(256));
  return bytes;
}

std::string randomFields(RandomFields& random, int depth) {
  std::string bytes;
  for (std::uint64_t left = random.below(4); left > 0; --left) bytes += randomField(random, depth);
  return bytes;
}

void mutate(RandomFields& random, std::string& bytes, const std::string& other) {
  const auto place = [&](const std::string& in) {
    return static_cast<std::size_t>(random.below(in.size() + 1));
  };
  const std::size_t at = place(bytes);
  const std::size_t length = random.below(8) == 0 ? place(bytes) : static_cast<std::size_t>(random.below(6));
  switch (random.below(12)) {
    case 0:
      if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
      break;
    case 1:
      if (at < bytes.size()) bytes[at] = static_cast<char>(random.below(256));
      break;
    case 2:
      bytes.resize(at);
      break;
    case 3:
      bytes.erase(at, length);
      break;
    case 4:
      bytes.insert(at, 1, static_cast<char>(random.below(256)));
      break;
    case 5:
      bytes.insert(place(bytes), bytes.substr(at, length));
      break;
    case 6:
      bytes += other;  // parses as a message that is merged
      break;
    case 7:
      bytes.insert(at, other.substr(place(other), length));
      break;
    case 8:
      bytes = randomField(random, 2) + bytes;
      break;
    case 9:
      bytes += randomField(random, 3);
      break;
    case 10:
      bytes = key(random, 2) + sized(random, bytes);
      break;
    case 11:
      bytes.insert(at, kTexts[random.below(kTexts.size())]);
      break;
  }
}

}  // namespace naiad::test
