// Text from the network or the keyboard: made fit for a terminal, and read strictly.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace naiad {

/// Maximum number of characters in a room's name.
inline constexpr std::size_t kMaxRoomName = 32;
/// Rooms of a server.
inline constexpr std::size_t kMaxRooms = 64;
/// What a name has to be, for complaints.
inline constexpr const char* kRoomNameRule =
    "1 to 32 of a-z, A-Z, 0-9, '-', '_' and '.', beginning with a letter or digit";

/// kRoomNameRule holds.
bool isRoomName(std::string_view name);

/// `text` (UTF-8, perhaps malformed) cut to `max_characters`, each of them drawable in one cell: anything
/// else (control, escape, bidi, zero-width, wide) becomes '?'. Line breaks and tabs become blanks.
std::string safeText(const std::string& text, std::size_t max_characters);

/// A player's name: as above with the limit of names, without blanks at the ends; "player" if nothing is
/// left.
std::string safeName(const std::string& name);

/// Columns that a safe text occupies.
std::size_t columnsOf(const std::string& text);

/// The text with ASCII letters in lower case: names of hosts as DNS compares them.
std::string lowerCase(std::string_view text);
/// True if there is nothing but a-z, A-Z, 0-9, '-', '_' and '.'.
bool isPlainName(std::string_view text);

/// Bytes as lower-case hexadecimal digits, and back: digits of either case, and nothing else.
std::string hexText(std::string_view bytes);
inline std::string hexText(std::span<const std::uint8_t> bytes) {
  return hexText(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}
std::optional<std::string> bytesOfHex(std::string_view digits);

/// Returns the decimal number that the whole text is; nullopt if it is malformed or not in [least, most]. '-'
/// is accepted for signed types.
template <class Number>
std::optional<Number> readNumber(std::string_view text, Number least, Number most) {
  Number number{};
  const char* const p_end = text.data() + text.size();
  const auto [p_read, error] = std::from_chars(text.data(), p_end, number);
  if (error != std::errc() || p_read != p_end || number < least || number > most) return std::nullopt;
  return number;
}

}  // namespace naiad
