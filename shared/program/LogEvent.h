// Something worth a line of the log: a sentence for people, and the facts in it by name for programs.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace naiad {

/// The text format writes the sentence, the JSON format the sentence and the facts: both come from one event,
/// so that they cannot differ. A plain text is an event, too.
struct LogEvent {
  enum class Level { kError, kWarning, kInfo };
  /// Names are written as they are; values are escaped.
  using Fields = std::vector<std::pair<std::string, std::string>>;

  LogEvent(std::string sentence) : text(std::move(sentence)) {}  // NOLINT(google-explicit-constructor)
  LogEvent(const char* p_sentence) : text(p_sentence) {}         // NOLINT(google-explicit-constructor)
  LogEvent(Level how_bad, std::string sentence) : level(how_bad), text(std::move(sentence)) {}
  /// `what`: a literal, "joined". `sentence` has the fields' values in it.
  LogEvent(const char* what, std::string sentence, Fields facts)
      : name(what), text(std::move(sentence)), fields(std::move(facts)) {}
  /// For people the sentence stands behind "warning: ".
  static LogEvent warning(const std::string& sentence) { return {Level::kWarning, "warning: " + sentence}; }
  operator const std::string&() const { return text; }  // NOLINT(google-explicit-constructor)

  const char* name = "note";
  Level level = Level::kInfo;
  std::string text;
  Fields fields;
};

}  // namespace naiad
