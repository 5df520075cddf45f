// A JSON value (RFC 8259): parsed from text, or built and written as text.
//
// Only Json.cpp includes the library that parses and writes, because the library's headers take longer to
// compile than the sources that need a value.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace naiad {

class Json {
 public:
  using Array = std::vector<Json>;
  using Member = std::pair<std::string, Json>;
  using Object = std::vector<Member>;  ///< members in the order of insertion, with unique names

  /// Treatment of a name that occurs twice in an object. kKeepLast: its last value, in its first position.
  enum class Duplicates { kRefuse, kKeepLast };
  /// kCompact writes no blanks. kAscii writes one after each comma and colon, and escapes everything but
  /// printable ASCII, so that the text means the same in any encoding and in any terminal.
  enum class Style { kCompact, kAscii };

  Json() = default;  ///< null
  Json(bool value) : m_value(value) {}
  Json(double value) : m_value(value) {}  ///< NaN and infinities are written as null
  template <std::integral T>
  Json(T value) : m_value(std::conditional_t<std::signed_integral<T>, std::int64_t, std::uint64_t>{value}) {}
  Json(const void*) = delete;  // a pointer would become true
  Json(const char* p_text) : m_value(p_text) {}
  Json(std::string text) : m_value(std::move(text)) {}
  Json(Array elements) : m_value(std::move(elements)) {}
  Json(Object members) : m_value(std::move(members)) {}
  /// An object: Json{{"id", 7}, {"name", name}}.
  Json(std::initializer_list<Member> members) : m_value(Object(members)) {}

  /// Parses exactly one value. Returns nullopt for other text, including comments, NaN, NUL bytes, invalid
  /// UTF-8, half a surrogate pair, numbers beyond the range of a double, and arrays and objects nested more
  /// than `max_depth` deep. A value may take 50 times the memory of its text, so limit the text as well.
  static std::optional<Json> parse(std::string_view text, std::size_t max_depth,
                                   Duplicates duplicates = Duplicates::kRefuse);
  /// Writes the value on one line. Invalid UTF-8 becomes U+FFFD.
  std::string toString(Style style = Style::kCompact) const;

  // Each getter returns nullptr or nullopt if the value is of another kind.

  const bool* boolean() const { return std::get_if<bool>(&m_value); }
  /// Returns an integer that fits 64 bits with a sign; nullopt for a fraction or an exponent too (1.0, 1e3).
  std::optional<std::int64_t> integer() const;
  /// Returns a number of any kind, rounded to a double.
  std::optional<double> number() const;
  const std::string* text() const { return std::get_if<std::string>(&m_value); }
  const Array* array() const { return std::get_if<Array>(&m_value); }
  const Object* object() const { return std::get_if<Object>(&m_value); }

  /// True for an integer that fits 64 bits, signed or unsigned.
  bool isInteger() const { return integer() || std::holds_alternative<std::uint64_t>(m_value); }
  /// Returns the text, or an empty one if the value is of another kind.
  std::string textOrEmpty() const { return text() != nullptr ? *text() : std::string(); }
  /// Returns the member, or nullptr if it is missing or this is not an object. Time is linear in the members.
  const Json* find(std::string_view name) const;
  /// Like find(), but returns a JSON null instead of nullptr: json["status"]["ports"].
  const Json& operator[](std::string_view name) const;
  /// Sets a member; an existing one keeps its position. Values of other types become an empty object first.
  void set(std::string_view name, Json value);

 private:
  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object> m_value;
};

}  // namespace naiad
