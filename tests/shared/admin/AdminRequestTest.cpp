#include <gtest/gtest.h>

#include <set>

#include "shared/admin/AdminRequest.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

using Words = std::vector<std::string>;
using Arguments = std::map<std::string, std::string>;

Arguments argumentsOf(const Words& words) {
  return readAdminRequest(words).arguments;
}

std::string complaintAbout(const Words& words) {
  return test::errorOf<AdminUsageError>([&words] { readAdminRequest(words); });
}

TEST(AdminCommands, HaveUniqueNamesAndParsableArguments) {
  std::set<std::string> names;
  for (const AdminCommand& command : adminCommands()) {
    EXPECT_TRUE(names.insert(command.name).second) << command.name;
    EXPECT_EQ(findAdminCommand(command.name), &command);
    EXPECT_FALSE(command.help.empty());
    bool may_end = false;
    for (const AdminArgument& argument : command.arguments) {
      EXPECT_FALSE(may_end && argument.required) << command.name << ": a required one after an optional one";
      may_end = !argument.required;
      EXPECT_EQ(argument.kind == AdminArgument::Kind::kChoice, !argument.one_of.empty());
      EXPECT_TRUE(argument.kind != AdminArgument::Kind::kText || &argument == &command.arguments.back());
    }
  }
  EXPECT_EQ(findAdminCommand("banana"), nullptr);
}

TEST(AdminRequest, TextArgumentTakesTheRestOfTheLine) {
  EXPECT_EQ(argumentsOf({"say", "the", "server", "ends"}), (Arguments{{"text", "the server ends"}}));
  EXPECT_EQ(argumentsOf({"kick", "Ann"}), (Arguments{{"player", "Ann"}}));
  EXPECT_EQ(argumentsOf({"kick", "Ann", "too", "loud"}),
            (Arguments{{"player", "Ann"}, {"reason", "too loud"}}));
}

TEST(AdminRequest, SpanArgumentMayBeOmitted) {
  EXPECT_EQ(argumentsOf({"ban", "Ann", "2h", "spam"}),
            (Arguments{{"who", "Ann"}, {"for", "2h"}, {"reason", "spam"}}));
  EXPECT_EQ(argumentsOf({"ban", "Ann", "spam"}), (Arguments{{"who", "Ann"}, {"reason", "spam"}}));
  EXPECT_EQ(argumentsOf({"drain"}), Arguments());
}

// Before a text, a number without a unit is a part of the text.
TEST(AdminRequest, EverySpanIsReadWithAndWithoutUnit) {
  int spans = 0;
  for (const AdminCommand& command : adminCommands()) {
    Arguments arguments;
    Words words{command.name};
    for (const AdminArgument& argument : command.arguments) {
      if (argument.kind != AdminArgument::Kind::kSpan) {
        if (argument.kind == AdminArgument::Kind::kText) continue;
        words.push_back(argument.one_of.empty() ? "Ann" : "in");
        arguments[argument.name] = words.back();
        continue;
      }
      ++spans;
      const bool text_follows = command.arguments.back().kind == AdminArgument::Kind::kText;
      for (const std::string span : {"2", "2s", "2.5", "2h"}) {
        arguments[argument.name] = span;
        EXPECT_EQ(readAdminRequest(command.name, arguments).of(argument.name), span) << command.name;
        words.push_back(span);
        const bool is_number = span.find_first_not_of("0123456789.") == std::string::npos;
        if (text_follows) words.insert(words.end(), {"many", "insults"});
        EXPECT_EQ(readAdminRequest(words).of(argument.name), text_follows && is_number ? "" : span)
            << command.name;
        if (text_follows) {
          EXPECT_EQ(readAdminRequest(words).of(command.arguments.back().name),
                    is_number ? span + " many insults" : "many insults");
        }
        words.resize(words.size() - (text_follows ? 3 : 1));
      }
    }
  }
  EXPECT_EQ(spans, 4) << "of ban, allow, restart and drain";
}

TEST(AdminRequest, NamedArgumentsMayAppearAnywhere) {
  EXPECT_EQ(argumentsOf({"scores", "--room", "one", "keys", "3"}),
            (Arguments{{"room", "one"}, {"table", "keys"}, {"count", "3"}}));
  EXPECT_EQ(argumentsOf({"scores", "keys", "--game=a=b"}), (Arguments{{"table", "keys"}, {"game", "a=b"}}));
  EXPECT_EQ(complaintAbout({"scores", "--room"}), "--room requires a value.");
  EXPECT_EQ(complaintAbout({"scores", "--room="}), "scores: room is empty.");
  EXPECT_NE(complaintAbout({"scores", "--rom", "x"}).find("has no option --rom. Usage: scores [TABLE]"),
            std::string::npos);
  EXPECT_NE(adminUsage(*findAdminCommand("scores")).find("[--room ROOM] [--game GAME]"), std::string::npos);
  EXPECT_EQ(argumentsOf({"say", "--room", "is", "open"}), (Arguments{{"text", "--room is open"}}))
      << "of commands that have none it is a word";
}

TEST(AdminRequest, ChoicesMayHaveDashes) {
  EXPECT_EQ(argumentsOf({"restart", "--in", "60s"}), (Arguments{{"when", "in"}, {"span", "60s"}}));
  EXPECT_EQ(argumentsOf({"restart", "at-round-end"}), (Arguments{{"when", "at-round-end"}}));
  EXPECT_EQ(argumentsOf({"vote", "kick", "Ann"}), (Arguments{{"what", "kick"}, {"player", "Ann"}}));
}

TEST(AdminRequest, InvalidRequestsGetAClearMessage) {
  EXPECT_EQ(complaintAbout({}), "A command is missing.");
  EXPECT_EQ(complaintAbout({"kik"}), "There is no command \"kik\"; did you mean \"kick\"?");
  EXPECT_EQ(complaintAbout({"kick"}), "Usage: kick PLAYER [REASON]");
  EXPECT_EQ(complaintAbout({"kick", ""}), "kick: player is empty.");
  EXPECT_EQ(complaintAbout({"who", "now"}), "Usage: who");
  EXPECT_EQ(complaintAbout({"vote", "ban", "Ann"}), "vote: \"ban\" is not one of: kick.");
  EXPECT_EQ(complaintAbout({"restart", "soon"}), "Usage: restart [now|at-round-end|in|keep] [SPAN]");
  EXPECT_EQ(complaintAbout({"say", std::string(2000, 'x')}), "say: text is too long.");
}

TEST(AdminRequest, ReadsArgumentsByName) {
  const AdminRequest request = readAdminRequest("ban", {{"who", "192.0.2.0/24"}, {"for", "7d"}});
  EXPECT_EQ(request.of("who"), "192.0.2.0/24");
  EXPECT_FALSE(request.has("reason"));
  EXPECT_THROW(readAdminRequest("ban", {{"who", "Ann"}, {"whom", "Bob"}}), AdminUsageError);
  EXPECT_THROW(readAdminRequest("ban", {{"who", "Ann"}, {"for", "long"}}), AdminUsageError);
  EXPECT_THROW(readAdminRequest("ban", {}), AdminUsageError);
}

TEST(AdminRequest, PasswordsAreRedactedInTheLog) {
  EXPECT_EQ(readAdminRequest({"password", "hunter2"}).redacted(), "password ***");
  EXPECT_EQ(readAdminRequest({"admin", "hunter2"}).redacted(), "admin ***");
  EXPECT_EQ(readAdminRequest({"kick", "Ann"}).redacted(), "kick \"Ann\"");
}

TEST(AdminRequest, SplitsALineIntoWords) {
  EXPECT_EQ(splitAdminLine("kick \"Ann Bee\"  too loud"), (Words{"kick", "Ann Bee", "too", "loud"}));
  EXPECT_EQ(splitAdminLine("  "), Words());
  EXPECT_EQ(splitAdminLine("tell \"\" x"), (Words{"tell", "", "x"}));
  EXPECT_EQ(splitAdminLine("a\"b c\"d \"open end"), (Words{"ab cd", "open end"}));
}

}  // namespace
}  // namespace naiad
