#include "shared/options/Options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <type_traits>

#include "shared/values/Version.h"

namespace naiad {
namespace {

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

void describe(CLI::App& app, const Option& row, CLI::Option& option) {
  if (row.name.front() != '-') option.required();
  if (row.range && row.range->whole) {
    option.check(CLI::Range(static_cast<int>(row.range->least), static_cast<int>(row.range->most)));
  } else if (row.range) {
    option.check(CLI::Range(row.range->least, row.range->most));
  }
  if (!row.one_of.empty()) option.check(CLI::IsMember(row.one_of));
  if (!row.type.empty()) option.type_name(row.type);
  if (!row.excludes.empty()) option.excludes(app.get_option(row.excludes));
  if (!row.default_text.empty()) option.default_str(row.default_text);
  if (row.hidden) option.group("");
}

}  // namespace

Parsed parseOptions(const Program& program, const std::vector<Option>& options, int argc,
                    const char* const* argv) {
  CLI::App app(program.purpose, program.name);
  app.set_version_flag("--version", program.name + " " + kVersion);
  if (program.has_config) {
    app.set_config("--config", "", "Read options from this file (lines like: port = 9876)");
    app.allow_config_extras(CLI::config_extras_mode::error);  // a misspelt option must not be passed over
  }
  app.footer(program.footer);
  std::vector<CLI::Option*> added;
  for (const Option& row : options) {
    added.push_back(addTo(app, row));
    describe(app, row, *added.back());
    added.back()->envname(row.environment);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? Parsed::kDone : Parsed::kUsageError;
  }
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (options[i].p_given != nullptr) *options[i].p_given = added[i]->count() > 0;
  }
  return Parsed::kRun;
}

void parseArguments(const std::vector<Option>& options, std::vector<std::string> arguments) {
  CLI::App app;
  for (const Option& row : options) describe(app, row, *addTo(app, row));
  std::reverse(arguments.begin(), arguments.end());  // as the parser wants them
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    throw OptionError(error.what());
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
