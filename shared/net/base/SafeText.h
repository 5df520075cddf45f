// Text from the network or the keyboard: sanitized for a terminal, and parsed strictly.
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
/// Maximum number of rooms of a server.
inline constexpr std::size_t kMaxRooms = 64;
/// The rule for room names, as a part of error messages.
inline constexpr const char* kRoomNameRule =
    "1 to 32 of a-z, A-Z, 0-9, '-', '_' and '.', beginning with a letter or digit";

/// True if the name obeys kRoomNameRule.
bool isRoomName(std::string_view name);

/// Returns at most `max_characters` of `text` (UTF-8, possibly malformed), each drawable in one cell. Other
/// characters (for example control, bidi, zero-width, wide) become '?', line breaks and tabs become blanks.
std::string safeText(const std::string& text, std::size_t max_characters);

/// Makes a name of the text's drawable characters, truncated and trimmed; "player" if it is empty.
std::string safeName(const std::string& name);

/// Returns the number of columns that a safe text occupies.
std::size_t columnsOf(const std::string& text);

/// Returns the text with ASCII letters in lower case, for names whose case does not matter (DNS).
std::string lowerCase(std::string_view text);
/// True if the text has no characters but a-z, A-Z, 0-9, '-', '_' and '.'.
bool isPlainName(std::string_view text);

/// Converts bytes to lower-case hexadecimal digits, and digits of either case to bytes (nullopt if invalid).
std::string hexText(std::string_view bytes);
inline std::string hexText(std::span<const std::uint8_t> bytes) {
  return hexText(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}
std::optional<std::string> bytesOfHex(std::string_view digits);

/// Parses the whole text as a decimal number; nullopt if it is malformed or not in [least, most]. '-' is
/// accepted for signed types.
template <class Number>
std::optional<Number> readNumber(std::string_view text, Number least, Number most) {
  Number number{};
  const char* const p_end = text.data() + text.size();
  const auto [p_read, error] = std::from_chars(text.data(), p_end, number);
  if (error != std::errc() || p_read != p_end || number < least || number > most) return std::nullopt;
  return number;
}

}  // namespace naiad
