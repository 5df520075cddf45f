#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>

#include "host/admin/BanList.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

asio::ip::address at(const std::string& text) {
  return asio::ip::make_address(text);
}

class BanListTest : public testing::Test {
 protected:
  fs::path file() const { return folder / "bans.sqlite3"; }
  BanList::Clock clock() {
    return [this] { return now; };
  }
  Ban ofRange(const std::string& text) const {
    return {.kind = Ban::Kind::kRange, .range = AddressRange::parse(text), .made = now};
  }
  Ban ofName(const std::string& name) const { return {.name = name, .made = now}; }
  /// Adds a ban and waits for the disk. Returns the problem, "" if none.
  static std::string add(BanList& list, const Ban& ban) {
    std::promise<std::string> saved;
    EXPECT_TRUE(list.add({ban}, [&saved](const std::string& problem) { saved.set_value(problem); }));
    return saved.get_future().get();
  }
  static std::size_t remove(BanList& list, const std::string& text) {
    std::promise<void> saved;
    const std::size_t count = list.remove(text, [&saved](const std::string&) { saved.set_value(); });
    if (count > 0) saved.get_future().wait();
    return count;
  }
  void execute(const char* p_command) const {
    sqlite3* p_database = nullptr;
    ASSERT_EQ(sqlite3_open(file().c_str(), &p_database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(p_database, p_command, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(p_database);
  }
  static void reload(BanList& list) {
    std::promise<std::vector<Ban>> loaded;
    ASSERT_TRUE(list.reload([&loaded](std::vector<Ban> bans, const std::string& problem) {
      EXPECT_EQ(problem, "");
      loaded.set_value(std::move(bans));
    }));
    list.replaceAll(loaded.get_future().get());
  }

  const test::TempFolder folder;
  Ban::Time now{1'800'000'000s};
  JobThread worker;
};

TEST_F(BanListTest, RangeBanAppliesOnlyToItsAddresses) {
  BanList list(worker, {}, clock());
  add(list, ofRange("192.0.2.0/24"));
  add(list, ofRange("2001:db8::5"));
  EXPECT_TRUE(list.isBanned(at("192.0.2.7")));
  EXPECT_TRUE(list.isBanned(at("::ffff:192.0.2.7")));
  EXPECT_FALSE(list.isBanned(at("192.0.3.7")));
  EXPECT_TRUE(list.isBanned(at("2001:db8::9:9:9:9"))) << "the same /64";
  EXPECT_FALSE(list.isBanned(at("2001:db8:0:1::5")));
  EXPECT_EQ(list.count(), 3u);
}

TEST_F(BanListTest, ExceptionOverridesAllRangeBans) {
  BanList list(worker, {}, clock());
  add(list, ofRange("192.0.2.0/24"));
  add(list, ofRange("192.0.0.0/16"));
  Ban exception = ofRange("192.0.2.7");
  exception.kind = Ban::Kind::kException;
  add(list, exception);
  EXPECT_FALSE(list.isBanned(at("192.0.2.7")));
  EXPECT_TRUE(list.isBanned(at("192.0.2.8")));
  EXPECT_EQ(remove(list, "192.0.2.7"), 1u);
  EXPECT_TRUE(list.isBanned(at("192.0.2.7")));
}

TEST_F(BanListTest, LoopbackIsNeverBanned) {
  BanList list(worker, {}, clock());
  add(list, ofRange("127.0.0.0/8"));
  add(list, ofRange("::/16"));
  EXPECT_FALSE(list.isBanned(at("127.0.0.1")));
  EXPECT_FALSE(list.isBanned(at("::ffff:127.0.0.1")));
  EXPECT_FALSE(list.isBanned(at("::1")));
}

TEST_F(BanListTest, BanExpiresAtItsEndTime) {
  BanList list(worker, folder, clock());
  Ban ban = ofRange("192.0.2.7");
  ban.until = now + 2h;
  EXPECT_EQ(add(list, ban), "");
  now += 2h - 1s;
  EXPECT_TRUE(list.isBanned(at("192.0.2.7")));
  now += 1s;
  EXPECT_FALSE(list.isBanned(at("192.0.2.7")));
  JobThread other;
  EXPECT_TRUE(BanList(other, folder, clock()).currentSet()->all().empty());
}

TEST_F(BanListTest, NameBanAppliesToLookalikeNames) {
  BanList list(worker, {}, clock());
  Ban ban = ofName("Bob");
  ban.reason = "spam";
  ban.until = now + 1h;
  add(list, ban);
  const std::string sentence = list.refusal(at("198.51.100.1"), "Bob");
  EXPECT_NE(sentence.find("banned"), std::string::npos);
  EXPECT_NE(sentence.find("spam"), std::string::npos);
  EXPECT_NE(sentence.find("until 2027-01-15 09:00 UTC"), std::string::npos) << sentence;
  EXPECT_NE(list.refusal(at("198.51.100.1"), "B\u03bfb"), "") << "with a Greek omicron";
  EXPECT_EQ(list.refusal(at("198.51.100.1"), "Bobby"), "");
}

TEST_F(BanListTest, BansLastBeyondARestart) {
  {
    BanList list(worker, folder, clock());
    Ban ban = ofRange("192.0.2.0/24");
    ban.reason = "a 'quoted' reason; DROP TABLE bans";
    ban.by = "user 0";
    ban.until = now + 24h;
    EXPECT_EQ(add(list, ban), "");
    EXPECT_EQ(add(list, ofName("Bob")), "");
    EXPECT_EQ(add(list, ofName("Eve")), "");
    EXPECT_EQ(remove(list, "name:Eve"), 1u);
  }
  JobThread other;
  BanList again(other, folder, clock());
  ASSERT_EQ(again.currentSet()->all().size(), 2u);
  const auto set = again.currentSet();
  const Ban* p_ban = set->find(at("192.0.2.200"), now);
  ASSERT_NE(p_ban, nullptr);
  EXPECT_EQ(p_ban->reason, "a 'quoted' reason; DROP TABLE bans");
  EXPECT_EQ(p_ban->by, "user 0");
  EXPECT_EQ(p_ban->until, std::optional(now + 24h));
  EXPECT_NE(again.refusal(at("198.51.100.1"), "Bob"), "");
  EXPECT_EQ(test::modeOf(file()) & 0077, 0u) << "other users may not read the addresses of players";
}

TEST_F(BanListTest, NewBanOfSameRangeReplacesTheOld) {
  BanList list(worker, folder, clock());
  Ban ban = ofRange("192.0.2.7");
  ban.until = now + 1h;
  add(list, ban);
  ban.until.reset();
  add(list, ban);
  EXPECT_EQ(list.currentSet()->all().size(), 1u);
  JobThread other;
  BanList again(other, folder, clock());
  ASSERT_EQ(again.currentSet()->all().size(), 1u);
  EXPECT_FALSE(again.currentSet()->all().front().until);
}

TEST_F(BanListTest, ABanIsLiftedByItsNumber) {
  BanList list(worker, {}, clock());
  add(list, ofRange("192.0.2.7"));
  add(list, ofRange("192.0.2.8"));
  const std::uint64_t number = list.currentSet()->all().back().number;
  EXPECT_EQ(remove(list, "#" + std::to_string(number)), 1u);
  EXPECT_EQ(remove(list, "#" + std::to_string(number)), 0u);
  EXPECT_FALSE(list.isBanned(at("192.0.2.8")));
  EXPECT_TRUE(list.isBanned(at("192.0.2.7")));
}

TEST_F(BanListTest, InvalidFileIsAnErrorAndIsNotOverwritten) {
  for (const std::string& content : {std::string(), std::string("not a database, by any means, at all\n"),
                                     std::string("SQLite format 3\0 and then nothing", 33)}) {
    std::ofstream(file(), std::ios::binary | std::ios::trunc) << content;
    EXPECT_THROW(BanList(worker, folder, clock()), BanFileError) << content;
    std::ifstream after(file(), std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(after), {}), content);
  }
  fs::remove(file());
  fs::create_directory(file());
  EXPECT_THROW(BanList(worker, folder, clock()), BanFileError);
}

TEST_F(BanListTest, ADamagedFileOfBansIsAnError) {
  {
    BanList list(worker, folder, clock());
    for (int i = 0; i < 40; ++i) add(list, ofRange("198.51.100." + std::to_string(i)));
    worker.finish();
  }
  std::fstream bytes(file(), std::ios::binary | std::ios::in | std::ios::out);
  bytes.seekp(4096 + 2);
  bytes << std::string(3000, '\x5a');
  bytes.close();
  JobThread other;
  EXPECT_THROW(BanList(other, folder, clock()), BanFileError);
}

TEST_F(BanListTest, DatabaseWithAnotherSchemaIsAnError) {
  execute("CREATE TABLE bans(x)");
  EXPECT_THROW(BanList(worker, folder, clock()), BanFileError);
}

// Simulates a full disk: the folder cannot be created.
TEST_F(BanListTest, UnsavedBanAppliesAndReloadSavesIt) {
  const fs::path blocked = folder / "state";
  std::ofstream(blocked) << "in the way";
  BanList list(worker, blocked, clock());
  EXPECT_NE(add(list, ofRange("192.0.2.7")), "");
  EXPECT_TRUE(list.isBanned(at("192.0.2.7")));
  fs::remove(blocked);
  reload(list);
  EXPECT_TRUE(list.isBanned(at("192.0.2.7")));
  JobThread other;
  EXPECT_TRUE(BanList(other, blocked, clock()).isBanned(at("192.0.2.7")));
}

TEST_F(BanListTest, UnsavedRemovalAppliesAndReloadSavesIt) {
  BanList list(worker, folder, clock());
  EXPECT_EQ(add(list, ofRange("192.0.2.7")), "");
  execute("ALTER TABLE bans RENAME TO gone");
  EXPECT_EQ(remove(list, "192.0.2.7"), 1u);
  execute("ALTER TABLE gone RENAME TO bans");
  reload(list);
  EXPECT_FALSE(list.isBanned(at("192.0.2.7")));
  JobThread other;
  EXPECT_FALSE(BanList(other, folder, clock()).isBanned(at("192.0.2.7")));
}

TEST_F(BanListTest, BanWithoutAFolderAppliesAndReportsAProblem) {
  BanList list(worker, {}, clock());
  EXPECT_NE(add(list, ofRange("192.0.2.7")), "");
  EXPECT_TRUE(list.isBanned(at("192.0.2.7")));
}

TEST_F(BanListTest, BanBeyondTheLimitIsRefused) {
  BanList list(worker, {}, clock());
  std::vector<Ban> bans;
  for (std::uint32_t i = 1; i < BanList::kMaxBans; ++i)
    bans.push_back(ofRange(asio::ip::make_address_v4(0x0a000000 + i).to_string()));
  list.replaceAll(std::move(bans));
  EXPECT_FALSE(list.add({ofRange("192.0.2.7"), ofName("Bob")}, [](const std::string&) {}));
  EXPECT_FALSE(list.isBanned(at("192.0.2.7")));
  EXPECT_TRUE(list.isBanned(at("10.0.1.1")));
  EXPECT_FALSE(list.isBanned(at("11.0.1.1")));
}

}  // namespace
}  // namespace naiad
