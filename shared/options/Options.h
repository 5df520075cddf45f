// A program's table of options, which defines its command line, its environment variables and its --help.
//
// A program lists its options as values, in the order of --help; parseOptions() parses them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "shared/options/Duration.h"

namespace naiad {

/// Returns the name that needs the fewest changes: a character inserted, deleted or replaced, or two
/// neighbours swapped. If `typed` is the beginning of a name, at least 4 characters long, that counts as one
/// change. Returns "" if the changes are more than a third of the length of `typed`, or `typed` has over 64
/// bytes.
std::string nearestName(const std::string& typed, const std::vector<std::string>& names);
/// Returns "; did you mean NAME?" with the nearest name, or "".
std::string suggestion(const std::string& typed, const std::vector<std::string>& names);

/// Returns a message, with the nearest known name, for each environment variable that begins with `prefix`
/// and is not in `known`: it may be misspelt. `p_environment`: entries NAME=VALUE, then a null.
std::vector<std::string> unknownVariableWarnings(const char* const* p_environment, const std::string& prefix,
                                                 const std::vector<std::string>& known);

/// Returns the environment variable of an option: "NAIAD_MAX_PLAYERS" for "--max-players".
std::string variableNameOf(const std::string& option_name);

/// Returns the name that an option had before it was renamed, which this version still accepts on the command
/// line, in --config files, and as a variable; "" if it had none.
std::string formerNameOf(const std::string& option_name);

/// A function that stores a text. Returns an error message, or "" if the text is valid.
using StoreText = std::function<std::string(const std::string& text)>;

/// The variable that receives an option's value. A bool makes it a flag without a value.
using OptionTarget = std::variant<bool*, int*, std::int64_t*, double*, std::string*, std::filesystem::path*,
                                  std::optional<double>*, std::optional<std::uint32_t>*,
                                  std::optional<std::uint64_t>*, StoreText>;

/// The range of a number; both ends are allowed.
struct OptionRange {
  double min = 0;
  double max = 0;
  std::int64_t unit = 0;  ///< unit of a duration without one, in microseconds; 0: not a duration
};

struct Option {
  std::string name;  ///< "--port"; without dashes: an argument, required unless is_optional
  OptionTarget target;
  std::string help;
  std::string environment{};           ///< environment variable that also sets the option; empty: none
  std::optional<OptionRange> range{};  ///< unset: any number
  std::vector<std::string> one_of{};   ///< allowed texts; empty: any
  std::string type{};                  ///< type of the value in --help; empty: derived from the target
  std::string excludes{};              ///< name of an earlier option that cannot be combined with this one
  bool shows_default = false;          ///< --help shows the target's value before parsing as the default
  std::string default_text{};          ///< default shown in --help instead of the target's value
  bool hidden = false;                 ///< not shown in --help
  bool is_secret = false;              ///< its value is never printed
  bool is_optional = false;            ///< argument that may be omitted
  bool joins = false;                  ///< text that may be repeated; the values are joined with blanks
  bool* p_given = nullptr;             ///< becomes true if the option was given
  bool* p_from_environment = nullptr;  ///< becomes true if the variable gave it
  std::string* p_location = nullptr;   ///< becomes "FILE:LINE" if the --config file gave it
};

/// Returns an option whose value is called `type` in --help, for example "FILE".
inline Option typedOption(std::string name, std::string type, OptionTarget target, std::string help) {
  Option option{std::move(name), std::move(target), std::move(help)};
  option.type = std::move(type);
  return option;
}

struct Program {
  std::string name;         ///< "dfserver"
  std::string purpose;      ///< the first line of --help
  std::string footer;       ///< the end of --help
  bool has_config = false;  ///< accepts --config FILE
};

/// The --help text of --config.
inline constexpr const char* kConfigHelp = "Read options from this file (lines like: port = 9876)";

enum class ParseResult {
  kRun,
  kDone,        ///< --help, --version or --option-page (OptionPages.h): printed
  kUsageError,  ///< wrong usage: printed
};

/// Stores the options from the command line, the environment and the --config file; the first of these that
/// sets an option has precedence. Prints help, version, usage errors and notes on former names. Errors and
/// notes go to stderr, prefixed by the program's name, with file and line for an option in a file and the
/// nearest name for an unknown one.
ParseResult parseOptions(const Program& program, const std::vector<Option>& options, int argc,
                         const char* const* argv);
/// Returns the exit code after parsing: 0, or 2 for wrong usage; nullopt if the program is to run.
std::optional<int> exitCodeOf(ParseResult parsed);

/// Like parseOptions(), but prints no errors or notes: for a running program. Throws OptionError.
void readOptions(const Program& program, const std::vector<Option>& options, int argc,
                 const char* const* argv);

/// An unknown option, an invalid value or an unreadable --config file. what() has a sentence that names it;
/// for the lines of a file, one sentence per wrong line, separated by newlines.
class OptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns the value of the option's environment variable, or of its former one; "" if neither is set.
std::string environmentValue(const Option& option);

/// Stores a value in the option's target. Throws OptionError with `place`, the value's origin, in front.
void storeValue(const Option& option, const std::string& value, const std::string& place);

/// Copies the value in the target of `from` to that of `to`; their types must be equal. A StoreText has no
/// value to copy.
void copyValue(const Option& from, const Option& to);

/// Returns the value in the option's target as text; "" for a StoreText or an unset optional.
std::string currentValue(const Option& option);

}  // namespace naiad
