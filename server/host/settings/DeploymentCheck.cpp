#include "host/settings/DeploymentCheck.h"

#include <sys/un.h>
#include <unistd.h>

#include <asio/ip/address.hpp>
#include <cerrno>
#include <chrono>
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <system_error>

#include "host/auth/PasswordHash.h"
#include "host/auth/ServerIdentity.h"
#include "host/settings/GameModule.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

enum ExitCode { kNoGame = 3, kCannotListen = 4, kFile = 5 };

void requireAccess(const fs::path& path, int mode) {
  if (::access(path.c_str(), mode) != 0)
    throw std::runtime_error(path.lexically_normal().string() + ": " + std::generic_category().message(errno));
}

/// Requires that files can be created in the folder.
void requireFolder(const fs::path& folder) {
  requireAccess(folder.empty() ? "." : folder / ".", W_OK | X_OK);
}

/// Like requireFolder(), but the server creates a missing folder.
void requireOwnFolder(const fs::path& path) {
  fs::path folder = fs::absolute(path);
  while (!fs::exists(folder)) folder = folder.parent_path();
  requireFolder(folder);
}

void requireReadable(const fs::path& file) {
  requireAccess(file, R_OK);
}

/// Requires that a file can be created or replaced.
void requireNewFile(const fs::path& file) {
  requireRegular(file);
  requireFolder(file.parent_path());
}

/// Requires that a file can be created or, if it exists, written. A device may only be the log.
void requireOpenFile(const fs::path& file) {
  if (!fs::is_character_file(file)) requireRegular(file);
  if (fs::exists(file)) return requireAccess(file, W_OK);
  requireFolder(file.parent_path());
}

void requireSocketName(const std::string& path) {
  if (path.size() >= sizeof(sockaddr_un::sun_path)) throw std::runtime_error("the path is too long for a socket");
}

void requireSocket(const fs::path& path) {
  requireSocketName(path.string());
  requireFolder(path.parent_path());
}

void requireControl(const fs::path& path) {
  requireSocketName(path.string() + ".new");  // its name until it is ready
  requireOwnFolder(fs::absolute(path).parent_path());
}

void requireGame(const std::string& game) {
  const fs::path module = GameModule::find(game);
  if (!fs::exists(module)) throw GameError("There is no game " + module.string() + ".");
}

void requireAddress(const HostOptions& options) {
  std::error_code error;
  const auto address = asio::ip::make_address(options.address, error);
  if (error)
    throw std::runtime_error("\"" + options.address + "\" is not a numeric IPv4 or IPv6 address.");
  if (options.insecure && !address.is_loopback())
    throw std::runtime_error("Cannot listen on " + options.address +
                             ": connections are not encrypted, so only loopback addresses are allowed.");
}

void requireIdentity(const HostOptions& options) {
  if (options.insecure) return;
  if (!options.certificate.empty()) return void(ServerIdentity::load(options.certificate, options.key));
  const fs::path folder =
      options.identity.empty() ? ServerIdentity::defaultDirectory() : fs::path(options.identity);
  if (fs::exists(folder / "certificate.pem"))
    return void(ServerIdentity::loadOrMake(folder, std::chrono::system_clock::now()));
  requireOwnFolder(folder);
}

/// A password itself is not checked, because hashing it takes long.
void requireHash(const std::string& password) {
  if (password.starts_with('$')) PasswordHash::fromText(password);
}

}  // namespace

std::vector<DeploymentProblem> deploymentProblems(const HostOptions& options) {
  std::vector<DeploymentProblem> problems;
  const auto check = [&problems](ExitCode code, const std::string& prefix, const auto& require,
                                 const auto& value) {
    try {
      require(value);
    } catch (const std::exception& error) {
      problems.push_back({code, prefix + error.what()});
    }
  };
  if (options.rooms.empty()) check(kNoGame, "", requireGame, options.game);
  check(kCannotListen, "", requireAddress, options);
  check(kFile, "", requireIdentity, options);
  check(kFile, "--password: ", requireHash, options.password);
  check(kFile, "--admin-password: ", requireHash, options.admin_password);
  const std::string journal = options.default_journal ? "" : options.journal;  // not required by default
  const struct {
    const char* p_option;
    const std::string& path;
    void (*require)(const fs::path& path);
    ExitCode code = kFile;
  } paths[] = {{"--log-file", options.log_file, requireOpenFile},
               {"--truth-file", options.truth_file, requireOpenFile},
               {"--port-file", options.port_file, requireNewFile},
               {"--join-file", options.join_file, requireNewFile},
               {"--status-file", options.status_file, requireNewFile},
               {"--state", options.state, requireOwnFolder},
               {"--journal", journal, requireOwnFolder},
               {"--bus-credentials", options.bus_credentials, requireReadable},
               {"--bus-ca", options.bus_ca, requireReadable},
               {"--proxy-socket", options.visitors, requireSocket, kCannotListen},
               {"--control", options.control, requireControl, kCannotListen}};
  for (const auto& one : paths) {
    if (!one.path.empty()) check(one.code, std::string(one.p_option) + " cannot be used: ", one.require, one.path);
  }
  return problems;
}

int reportDeploymentProblems(const HostOptions& options) {
  const std::vector<DeploymentProblem> problems = deploymentProblems(options);
  for (const DeploymentProblem& problem : problems) std::cerr << "dfserver: " << problem.text << "\n";
  return problems.empty() ? 0 : problems.front().exit_code;
}

}  // namespace naiad
