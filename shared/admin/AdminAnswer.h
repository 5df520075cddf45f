// The answer to an admin command.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace naiad {

using AdminValue = std::variant<std::string, std::int64_t, double, bool>;
/// Values by name, in the order in which they are shown.
using AdminRow = std::vector<std::pair<std::string, AdminValue>>;

struct AdminAnswer {
  bool ok = true;
  std::string text;                     ///< one sentence or empty; if not ok, the reason
  std::vector<std::string> candidates;  ///< the matches of an ambiguous name
  AdminRow facts;                       ///< facts about the server
  bool is_list = false;                 ///< `rows` is the answer, even if it is empty
  std::vector<AdminRow> rows;           ///< the rows of a list; all have equal column names

  /// Returns the answer to a command that succeeded.
  static AdminAnswer done(std::string text) { return {true, std::move(text), {}, {}, false, {}}; }
  /// Returns an answer that lists `rows`. Its text is `if_empty` if there are none.
  static AdminAnswer list(std::vector<AdminRow> rows, std::string if_empty) {
    std::string text = rows.empty() ? std::move(if_empty) : std::string();
    return {true, std::move(text), {}, {}, true, std::move(rows)};
  }
  /// Returns the answer to a command that did nothing; `text` gives the reason.
  static AdminAnswer refused(std::string text) { return {false, std::move(text), {}, {}, false, {}}; }
};

/// Returns the answer as lines for people: the sentence; the candidates; facts as "name: value"; rows in
/// columns under a line of headings. Control characters are escaped because names and reasons come from
/// untrusted people.
std::vector<std::string> answerText(const AdminAnswer& answer);

/// Returns "yes" or "" for a bool, a number as "3" or "0.25" (3 digits), or the text itself.
std::string valueText(const AdminValue& value);

}  // namespace naiad
