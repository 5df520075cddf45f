#include "shared/options/Options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "shared/net/base/SafeFile.h"
#include "shared/options/OptionPages.h"
#include "shared/values/Version.h"

namespace naiad {
namespace {

constexpr std::size_t kLongest = 64;                      ///< maximum bytes of a name that gets a suggestion
constexpr std::size_t kMaxConfig = std::size_t{1} << 20;  ///< maximum bytes of a --config file

/// Returns the optimal string alignment distance, computed row by row.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

CLI::Option* addTo(CLI::App& app, const Option& row) {
  return std::visit(
      [&]<class Target>(const Target& target) -> CLI::Option* {
        if constexpr (std::is_same_v<Target, bool*>) {
          return app.add_flag(row.name, *target, row.help);
        } else if constexpr (std::is_same_v<Target, StoreText>) {
          const auto store = [&row, &target](const std::string& text) {
            const std::string wrong = target(text);
            if (!wrong.empty()) throw CLI::ValidationError(row.name, wrong);
          };
          return app.add_option_function<std::string>(row.name, store, row.help);
        } else {
          CLI::Option* option = app.add_option(row.name, *target, row.help);
          return row.shows_default ? option->capture_default_str() : option;
        }
      },
      row.target);
}

/// Like CLI::Range, with one error message for all versions of CLI11.
template <class Number>
CLI::Validator within(const OptionRange& range) {
  const auto least = static_cast<Number>(range.min);
  const auto most = static_cast<Number>(range.max);
  const CLI::Range numbers(least, most);
  const auto check = [numbers, least, most](const std::string& value) {
    std::ostringstream wrong;
    if (!numbers(value).empty()) wrong << "Value " << value << " not in range " << least << " to " << most;
    return wrong.str();
  };
  return CLI::Validator(check, numbers.get_description());
}

/// Replaces a duration by its number of `unit`.
CLI::Validator inUnit(std::int64_t unit) {
  const auto replace = [unit](std::string& value) {
    const auto count = readDuration(value, unit);
    if (!count) return '"' + value + "\" is not a duration like 10, 10s, 5m or 2h";
    std::ostringstream text;
    text << std::setprecision(15) << *count;
    value = text.str();
    return std::string();
  };
  return CLI::Validator(replace, "");
}

/// Former and present names of renamed options of all programs.
constexpr std::pair<std::string_view, std::string_view> kRenamed[] = {
    {"--players", "--input-mode"},      {"--visitors", "--proxy-socket"}, {"--visitor", "--proxy-for"},
    {"--hang-time", "--tick-timeout"},  {"--grace", "--reconnect-time"},  {"--drain-time", "--drain-timeout"},
    {"--inactive-kick", "--idle-kick"}, {"--link-host", "--public-host"}, {"--audit", "--replica-audit"},
    {"--truth", "--truth-file"},        {"--log", "--log-file"}};

/// If `word` begins with the former name of an option, replaces that by the present name and adds a note.
void replaceFormerName(std::string& word, const std::vector<Option>& options,
                       std::vector<std::string>& notes) {
  const std::string typed = word.substr(0, word.find('='));
  for (const Option& option : options) {
    if (typed.empty() || formerNameOf(option.name) != typed) continue;
    word.replace(0, typed.size(), option.name);
    notes.push_back(typed + " is now " + option.name + "; the old name will be removed in the next version");
  }
}

void describe(CLI::App& app, const Option& row, CLI::Option& option) {
  if (row.name.front() != '-') option.required(!row.is_optional && environmentValue(row).empty());
  const bool counts =
      std::holds_alternative<int*>(row.target) || std::holds_alternative<std::int64_t*>(row.target);
  if (row.range) option.check(counts ? within<std::int64_t>(*row.range) : within<double>(*row.range));
  if (row.range && row.range->unit != 0) option.transform(inUnit(row.range->unit))->type_name("DURATION");
  if (!row.one_of.empty()) option.check(CLI::IsMember(row.one_of));
  if (!row.type.empty()) option.type_name(row.type);
  if (!row.excludes.empty()) option.excludes(app.get_option(row.excludes));
  if (!row.default_text.empty()) option.default_str(row.default_text);
  if (row.hidden) option.group("");
  if (row.joins) option.join(' ');
}

// ---- errors -----------------------------------------------------------------------------------------------

ParseResult reportUsageError(const Program& program, const std::string& sentence) {
  std::istringstream lines(sentence);
  for (std::string line; std::getline(lines, line);) std::cerr << program.name << ": " << line << "\n";
  std::cerr << "Run " << program.name << " --help for more information.\n";
  return ParseResult::kUsageError;
}

/// Returns the parser's message without the option's name in front.
std::string withoutName(const Option& option, const std::string& said) {
  const std::string prefix = option.name + ": ";
  return said.starts_with(prefix) ? said.substr(prefix.size()) : said;
}

std::vector<std::string> namesOf(const Program& program, const std::vector<Option>& options) {
  std::vector<std::string> names{"--help", "--version"};
  if (program.has_config) names.push_back("--config");
  for (const Option& option : options) {
    if (!option.hidden && option.name.front() == '-') names.push_back(option.name);
  }
  return names;
}

std::string unknownArgument(const Program& program, const std::vector<Option>& options, const CLI::App& app) {
  const std::vector<std::string> left = app.remaining();
  const auto found = std::find_if(left.begin(), left.end(), [](const auto& word) { return word[0] == '-'; });
  if (found == left.end())
    return "unexpected argument \"" + (left.empty() ? std::string() : left.front()) + "\"";
  const std::string name = found->substr(0, found->find('='));
  return "there is no option " + name + suggestion(name, namesOf(program, options));
}

// ---- the --config file ------------------------------------------------------------------------------------

std::string trimmed(const std::string& text) {
  constexpr const char* kBlanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// Parses the text after the `=`: a value in quotes, or one that ends at a # that begins the text or follows
/// a blank. Returns nullopt if the quotes do not end, or other text than a # comment follows them.
std::optional<std::string> configValue(const std::string& text) {
  if (text.starts_with('"') || text.starts_with('\'')) {
    const std::size_t end = text.find(text.front(), 1);
    if (end == std::string::npos) return std::nullopt;
    const std::string rest = trimmed(text.substr(end + 1));
    if (!rest.empty() && !rest.starts_with('#')) return std::nullopt;
    return text.substr(1, end - 1);
  }
  for (std::size_t at = text.find('#'); at != std::string::npos; at = text.find('#', at + 1)) {
    if (at == 0 || text[at - 1] == ' ' || text[at - 1] == '\t') return trimmed(text.substr(0, at));
  }
  return text;
}

/// Stores the value of a line, unless the command line or the environment set the option. Throws OptionError.
void storeConfigLine(const std::string& line, const std::string& place, const std::vector<Option>& options,
                     const std::vector<bool>& is_given, std::vector<std::string>& notes) {
  const std::size_t equals = line.find('=');
  std::string key = "--" + trimmed(line.substr(0, equals));
  replaceFormerName(key, options, notes);
  key.erase(0, 2);
  const auto found = std::find_if(options.begin(), options.end(),
                                  [&key](const Option& row) { return row.name == "--" + key; });
  if (found == options.end()) {
    std::vector<std::string> keys;
    for (const Option& row : options) {
      if (!row.hidden && row.name.starts_with("--")) keys.push_back(row.name.substr(2));
    }
    throw OptionError(place + ": there is no option \"" + key + '"' + suggestion(key, keys));
  }
  const bool is_flag = std::holds_alternative<bool*>(found->target);
  if (equals == std::string::npos && !is_flag) throw OptionError(place + ": expected \"" + key + " = …\"");
  const auto value = equals == std::string::npos ? "true" : configValue(trimmed(line.substr(equals + 1)));
  if (!value) throw OptionError(place + ": missing closing quote, or text after it");
  if (is_given[static_cast<std::size_t>(found - options.begin())]) return;
  const std::string before = found->joins ? currentValue(*found) : "";
  storeValue(*found, before.empty() ? *value : before + " " + *value, place + ": " + key);
  if (found->p_given != nullptr) *found->p_given = true;
  if (found->p_location != nullptr) *found->p_location = place;
}

/// Reads lines `name = value`; skips empty ones and # and ; comments. Throws OptionError: a line per error.
void readConfig(const std::string& path, const std::vector<Option>& options,
                const std::vector<bool>& is_given, std::vector<std::string>& notes) {
  std::istringstream file;
  try {
    const auto text = readTrusted(path, kMaxConfig, Links::kFollowed);
    if (!text) throw OptionError("--config: " + path + " cannot be read");
    file.str(*text);
  } catch (const std::system_error& error) {
    throw OptionError(std::string("--config: ") + error.what());
  }
  int number = 0;
  std::string wrong;
  for (std::string line; std::getline(file, line);) {
    const std::string place = path + ":" + std::to_string(++number);
    line = trimmed(line);
    if (line.empty() || line.front() == '#' || line.front() == ';') continue;
    try {
      storeConfigLine(line, place, options, is_given, notes);
    } catch (const OptionError& line_error) {
      wrong += (wrong.empty() ? "" : "\n") + std::string(line_error.what());
    }
  }
  if (!wrong.empty()) throw OptionError(wrong);
}

// ---- pages for the build ----------------------------------------------------------------------------------

/// Handles `PROGRAM --option-page KIND`. Returns nullopt for any other command line.
std::optional<ParseResult> printPage(const Program& program, const std::vector<Option>& options, int argc,
                                     const char* const* argv) {
  if (argc != 3 || std::string_view(argv[1]) != "--option-page") return std::nullopt;
  const auto page = optionPage(argv[2], program, options);
  if (!page) return reportUsageError(program, std::string("there is no page \"") + argv[2] + '"');
  std::cout << *page;
  return ParseResult::kDone;
}

/// Empties a text or path, for a line without a value, which the parser would reject. Returns false for other
/// options, and for those with a list of values.
bool clearText(const Option& option) {
  if (!option.one_of.empty()) return false;
  return std::visit(
      [](const auto& target) {
        constexpr bool kHolds = requires {
          target->clear();
        };
        if constexpr (kHolds) target->clear();
        return kHolds;
      },
      option.target);
}

/// Reads all options, and adds a note on each former name on the command line or in the --config file, but
/// not of a variable. Returns false after it printed --help or --version. Throws OptionError.
bool readAll(const Program& program, const std::vector<Option>& options, int argc, const char* const* argv,
             std::vector<std::string>& notes) {
  CLI::App app(program.purpose, program.name);
  app.set_version_flag("--version", program.name + " " + kVersion);
  std::string config;
  if (program.has_config) app.add_option("--config", config, kConfigHelp);
  app.footer(program.footer);
  std::vector<CLI::Option*> added;
  for (const Option& row : options) {
    added.push_back(addTo(app, row));
    describe(app, row, *added.back());
  }
  std::vector<std::string> words(argv + 1, argv + argc);
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i)
    replaceFormerName(words[i], options, notes);
  std::reverse(words.begin(), words.end());  // as CLI11 expects them
  try {
    app.parse(std::move(words));
  } catch (const CLI::ExtrasError&) {
    throw OptionError(unknownArgument(program, options, app));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw OptionError(error.what());
    for (std::size_t i = 0; i < options.size(); ++i) added[i]->envname(options[i].environment);  // for --help
    app.exit(error);
    return false;
  }
  std::vector<bool> is_given;
  for (std::size_t i = 0; i < options.size(); ++i) {
    const Option& option = options[i];
    // CLI11 2.4 ignores a variable with an invalid value, so variables are read here.
    const std::string value = added[i]->count() > 0 ? "" : environmentValue(option);
    if (!value.empty()) storeValue(option, value, option.environment);
    is_given.push_back(added[i]->count() > 0 || !value.empty());
    if (!is_given.back()) continue;
    if (option.p_given != nullptr) *option.p_given = true;
    if (option.p_from_environment != nullptr) *option.p_from_environment = !value.empty();
  }
  if (!config.empty()) readConfig(config, options, is_given, notes);
  return true;
}

}  // namespace

std::string variableNameOf(const std::string& option_name) {
  std::string variable = "NAIAD_" + option_name.substr(2);
  for (char& c : variable) c = c == '-' ? '_' : static_cast<char>(std::toupper(c));
  return variable;
}

std::string formerNameOf(const std::string& option_name) {
  for (const auto& [former, present] : kRenamed) {
    if (present == option_name) return std::string(former);
  }
  return {};
}

std::string environmentValue(const Option& option) {
  if (option.environment.empty()) return {};
  const std::string former = formerNameOf(option.name);
  const char* p_value = std::getenv(option.environment.c_str());
  if (p_value == nullptr && !former.empty()) p_value = std::getenv(variableNameOf(former).c_str());
  return p_value == nullptr ? "" : p_value;
}

std::string nearestName(const std::string& typed, const std::vector<std::string>& names) {
  if (typed.size() > kLongest) return {};
  std::string nearest;
  std::size_t least = typed.size() / 3 + 1;
  constexpr std::size_t kBeginning = 4;  // a shorter beginning is ambiguous: "--m" of "--max-players"
  for (const std::string& name : names) {
    const bool begins = typed.size() >= kBeginning && name.starts_with(typed);
    const std::size_t changes = begins ? 1 : distance(typed, name);
    if (changes >= least) continue;
    least = changes;
    nearest = name;
  }
  return nearest;
}

std::string suggestion(const std::string& typed, const std::vector<std::string>& names) {
  const std::string near = nearestName(typed, names);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

std::vector<std::string> unknownVariableWarnings(const char* const* p_environment, const std::string& prefix,
                                                 const std::vector<std::string>& known) {
  std::vector<std::string> sentences;
  for (; *p_environment != nullptr; ++p_environment) {
    const std::string_view entry(*p_environment);
    const std::string name(entry.substr(0, entry.find('=')));
    if (!name.starts_with(prefix) || std::find(known.begin(), known.end(), name) != known.end()) continue;
    sentences.push_back("there is no variable " + name + suggestion(name, known));
  }
  return sentences;
}

ParseResult parseOptions(const Program& program, const std::vector<Option>& options, int argc,
                         const char* const* argv) {
  if (const auto printed = printPage(program, options, argc, argv)) return *printed;
  try {
    std::vector<std::string> notes;
    const bool runs = readAll(program, options, argc, argv, notes);
    for (const std::string& note : notes) std::cerr << program.name << ": " << note << "\n";
    return runs ? ParseResult::kRun : ParseResult::kDone;
  } catch (const OptionError& error) {
    return reportUsageError(program, error.what());
  }
}

void readOptions(const Program& program, const std::vector<Option>& options, int argc,
                 const char* const* argv) {
  std::vector<std::string> notes;
  readAll(program, options, argc, argv, notes);
}

void copyValue(const Option& from, const Option& to) {
  std::visit(
      [&to]<class Target>(const Target& source) {
        if constexpr (std::is_pointer_v<Target>) *std::get<Target>(to.target) = *source;
      },
      from.target);
}

std::optional<int> exitCodeOf(ParseResult parsed) {
  constexpr int kWrongUsage = 2;
  if (parsed == ParseResult::kRun) return std::nullopt;
  return parsed == ParseResult::kDone ? 0 : kWrongUsage;
}

void storeValue(const Option& option, const std::string& value, const std::string& place) {
  if (value.empty() && clearText(option)) return;
  CLI::App app;
  describe(app, option, *addTo(app, option));
  std::vector<std::string> words{option.name + "=" + value};
  if (option.name.front() != '-') words = {value, "--"};  // CLI11 reads the last word first
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    throw OptionError(place + ": " + withoutName(option, error.what()));
  }
}

std::string currentValue(const Option& option) {
  return std::visit(
      []<class Target>(const Target& target) {
        std::ostringstream text;
        if constexpr (!std::is_same_v<Target, StoreText>) {
          if constexpr (requires { text << *target; }) {
            text << std::boolalpha << *target;
          } else if (target->has_value()) {
            text << **target;
          }
        }
        return text.str();
      },
      option.target);
}

}  // namespace naiad
