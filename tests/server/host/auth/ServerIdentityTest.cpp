#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "host/auth/ServerIdentity.h"
#include "shared/net/base/SafeFile.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

const auto kNow = std::chrono::system_clock::from_time_t(1'800'000'000);

struct ServerIdentityTest : testing::Test {
  ServerIdentity loadOrMake() const { return ServerIdentity::loadOrMake(directory, kNow); }
  static std::string contentOf(const fs::path& path) {
    return readSmallFile(path, 100'000).value_or("(missing)");
  }

  const test::TempFolder base;
  fs::path directory = base / "config" / "naiad";
};

TEST_F(ServerIdentityTest, WorldWritableFolderIsRefused) {
  fs::create_directories(directory);
  fs::permissions(directory, fs::perms::owner_all | fs::perms::others_write | fs::perms::others_exec);
  EXPECT_EQ(test::errorOf<TlsError>([&] { loadOrMake(); }),
            "The folder " + directory.string() +
                " has the server's key, but every user can write to it. Run: " + "chmod go-w " +
                directory.string());
  EXPECT_FALSE(fs::exists(directory / "key.pem"));
  fs::permissions(directory, fs::perms::owner_all | fs::perms::group_all);
  EXPECT_TRUE(test::has(loadOrMake().warning(), "its group can write to it"));
  fs::permissions(directory, fs::perms::owner_all);
  EXPECT_EQ(loadOrMake().warning(), "");
}

TEST_F(ServerIdentityTest, IsMadeOnceAndUsedAgain) {
  const Fingerprint first = loadOrMake().fingerprint();
  const std::string key = contentOf(directory / "key.pem");
  const std::string certificate = contentOf(directory / "certificate.pem");
  EXPECT_EQ(loadOrMake().fingerprint(), first);
  EXPECT_EQ(contentOf(directory / "key.pem"), key);
  EXPECT_EQ(contentOf(directory / "certificate.pem"), certificate);
}

TEST_F(ServerIdentityTest, KeyIsForItsOwnerAlone) {
  loadOrMake();
  EXPECT_EQ(test::modeOf(directory / "key.pem"), 0600U);
  EXPECT_EQ(test::modeOf(directory), 0700U);
  EXPECT_EQ(std::distance(fs::directory_iterator(directory), {}), 2);  // no temporary files left
}

TEST_F(ServerIdentityTest, OtherDirectoriesHaveOtherKeys) {
  EXPECT_NE(loadOrMake().fingerprint(), ServerIdentity::loadOrMake(base / "other", kNow).fingerprint());
}

TEST_F(ServerIdentityTest, LostCertificateIsRecreatedForTheSameKey) {
  const Fingerprint first = loadOrMake().fingerprint();
  fs::remove(directory / "certificate.pem");
  EXPECT_EQ(loadOrMake().fingerprint(), first);
}

TEST_F(ServerIdentityTest, LostKeyIsNotReplacedSilently) {
  loadOrMake();
  fs::remove(directory / "key.pem");
  EXPECT_TRUE(
      test::has(test::errorOf<TlsError>([&] { loadOrMake(); }), "is missing, but its certificate exists"));
  EXPECT_FALSE(fs::exists(directory / "key.pem"));
}

TEST_F(ServerIdentityTest, KeyThatOthersCanReadIsRefused) {
  loadOrMake();
  const fs::path key = directory / "key.pem";
  for (const auto extra : {fs::perms::group_read, fs::perms::others_read}) {
    fs::permissions(key, fs::perms::owner_read | extra);
    EXPECT_EQ(test::errorOf<TlsError>([&] { loadOrMake(); }),
              "The key file " + key.string() + " can be read by other users. Run: chmod 600 " + key.string());
  }
  fs::permissions(key, fs::perms::owner_read);
  EXPECT_EQ(test::errorOf<TlsError>([&] { loadOrMake(); }), "");
}

TEST_F(ServerIdentityTest, ExplicitFilesAreLoadedOrReportedMissing) {
  const Fingerprint made = loadOrMake().fingerprint();
  EXPECT_EQ(ServerIdentity::load(directory / "certificate.pem", directory / "key.pem").fingerprint(), made);
  EXPECT_EQ(test::errorOf<TlsError>([&] { ServerIdentity::load(base / "none.pem", directory / "key.pem"); }),
            "There is no certificate file " + (base / "none.pem").string() + ".");
  EXPECT_EQ(test::errorOf<TlsError>(
                [&] { ServerIdentity::load(directory / "certificate.pem", base / "none.pem"); }),
            "There is no key file " + (base / "none.pem").string() + ".");
}

TEST_F(ServerIdentityTest, WholeCertificateChainIsLoaded) {
  loadOrMake();
  const std::string above = makeCertificatePem(makeKeyPem(), kNow);
  const fs::path chain = base / "fullchain.pem";
  std::ofstream(chain) << contentOf(directory / "certificate.pem") << above;
  const ServerIdentity identity = ServerIdentity::load(chain, directory / "key.pem");
  STACK_OF(X509)* sent = nullptr;
  SSL_CTX_get0_chain_certs(identity.tls()->get(), &sent);
  EXPECT_EQ(sk_X509_num(sent), 1);
}

TEST_F(ServerIdentityTest, InvalidFilesGiveSpecificMessages) {
  loadOrMake();
  const auto complaintAbout = [&](const std::string& certificate, const std::string& key) {
    replaceFile(base / "certificate", certificate);
    replaceFile(base / "key", key);
    return test::errorOf<TlsError>([&] { ServerIdentity::load(base / "certificate", base / "key"); });
  };
  const std::string certificate = contentOf(directory / "certificate.pem");
  const std::string key = contentOf(directory / "key.pem");
  EXPECT_EQ(complaintAbout(certificate, key), "");
  EXPECT_EQ(complaintAbout(certificate, makeKeyPem()), "The certificate does not match the private key.");
  EXPECT_EQ(complaintAbout("nonsense", key), "The certificate is not in PEM form.");
  EXPECT_EQ(complaintAbout(certificate, "nonsense"),
            "The private key is not in PEM form, or is protected by a password.");
  const std::string cut = certificate.substr(0, certificate.size() / 2);
  EXPECT_EQ(complaintAbout(certificate + cut, key), "The chain of certificates is damaged.");
}

TEST_F(ServerIdentityTest, ServersThatStartTogetherHaveOneKey) {
  std::vector<std::string> seen(8);
  std::vector<std::thread> servers;
  for (std::string& fingerprint : seen) {
    servers.emplace_back([&] { fingerprint = loadOrMake().fingerprint().text(); });
  }
  for (std::thread& server : servers) server.join();
  for (const std::string& fingerprint : seen) EXPECT_EQ(fingerprint, seen[0]);
}

TEST_F(ServerIdentityTest, CertificateStartsYesterdayAndNeverExpires) {
  const ServerIdentity identity = loadOrMake();
  const X509* const certificate = SSL_CTX_get0_certificate(identity.tls()->get());
  EXPECT_EQ(ASN1_TIME_cmp_time_t(X509_get0_notBefore(certificate), 1'800'000'000 - 86'400), 0);
  EXPECT_EQ(ASN1_TIME_cmp_time_t(X509_get0_notAfter(certificate), 253'402'300'799), 0);
}

TEST(ServerIdentityDirectory, FollowsTheEnvironment) {
  const char* before = std::getenv("XDG_CONFIG_HOME");
  const std::string kept = before ? before : "";
  setenv("XDG_CONFIG_HOME", "/somewhere", 1);
  EXPECT_EQ(ServerIdentity::defaultDirectory(), "/somewhere/naiad");
  setenv("XDG_CONFIG_HOME", "relative", 1);
  EXPECT_EQ(ServerIdentity::defaultDirectory(), std::string(std::getenv("HOME")) + "/.config/naiad");
  before ? setenv("XDG_CONFIG_HOME", kept.c_str(), 1) : unsetenv("XDG_CONFIG_HOME");
}

}  // namespace
}  // namespace naiad
