#include "client/lan/ListDownload.h"

#include <algorithm>
#include <asio/io_context.hpp>
#include <memory>
#include <thread>
#include <utility>

#include "shared/net/http/HttpExchange.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

constexpr std::string_view kScheme = "https://";
constexpr std::uint16_t kHttpsPort = 443;
constexpr std::size_t kMaxUrl = 2000;

bool isPlain(std::string_view text) {
  return text.size() <= kMaxUrl &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

using Clock = std::chrono::steady_clock;
using End = HttpExchange::End;

/// Returns why there is no answer, as the end of a sentence.
std::string inWords(const HttpExchange::Result& result) {
  const std::string reason = result.detail.empty() ? "" : " (" + result.detail + ")";
  switch (result.end) {
    case End::kNotFound:
      return "host not found" + reason;
    case End::kUntrusted:
      return "no secure connection" + reason;
    case End::kConnectionLost:
      return "the server closed the connection" + reason;
    case End::kTooLong:
      return "it is longer than 1 MiB";
    case End::kBadAnswer:
      return "invalid HTTP answer" + reason;
    case End::kTimedOut:
      return "no complete answer within 5 s";
    default:
      return "cannot connect" + reason;
  }
}

DownloadError problemOf(const std::string& what) {
  return {"Cannot load the server list: " + what + "."};
}

bool isRedirect(unsigned status) {
  return status == 301 || status == 302 || status == 303 || status == 307 || status == 308;
}

/// One request and the io_context that runs it.
struct Download {
  explicit Download(std::shared_ptr<const TlsContext> context) : tls(std::move(context)) {}

  HttpExchange::Result run(const ListUrl& url, std::chrono::milliseconds timeout) {
    HttpRequest request{.target = url.target, .host = url.hostText()};
    request.fields = {{"User-Agent", "dfclient"}, {"Accept", "application/json"}, {"Connection", "close"}};
    std::optional<HttpExchange::Result> end;
    exchange->run({url.host, url.port, tls}, request, timeout,
                  [&end](const HttpExchange::Result& result) { end.emplace(result); });
    while (!end && io.run_one() > 0) {
    }
    return end.value_or(HttpExchange::Result{End::kTimedOut, {}});
  }

  asio::io_context io{1};
  std::shared_ptr<const TlsContext> tls;
  std::shared_ptr<HttpExchange> exchange =
      std::make_shared<HttpExchange>(io, HttpLimits{.body = kMaxListBytes});
};

/// Destroys `download` on another thread, because its io_context's destructor may wait long for the resolver.
void dropLater(std::unique_ptr<Download> download) {
  std::thread([kept = std::move(download)] {}).detach();
}

}  // namespace

std::optional<ListUrl> ListUrl::parse(std::string_view text) {
  if (!text.starts_with(kScheme) || !isPlain(text)) return std::nullopt;
  text = text.substr(kScheme.size());
  text = text.substr(0, text.find('#'));
  const std::size_t end = std::min(text.find_first_of("/?"), text.size());
  const auto where = LinkHost::parse(text.substr(0, end), kHttpsPort);
  if (!where) return std::nullopt;
  const std::string_view rest = text.substr(end);
  return ListUrl{where->host, where->port, (rest.starts_with('/') ? "" : "/") + std::string(rest)};
}

std::optional<ListUrl> ListUrl::redirected(std::string_view location) const {
  if (!location.starts_with('/') || location.starts_with("//")) return parse(location);
  if (!isPlain(location)) return std::nullopt;
  ListUrl url = *this;
  url.target = location.substr(0, location.find('#'));
  return url;
}

std::string ListUrl::hostText() const {
  return LinkHost{host, port}.text(kHttpsPort);
}

std::variant<std::string, DownloadError> downloadList(const ListUrl& url) {
  const auto tls = TlsContext::forWebClient();
  const auto end = Clock::now() + kListTimeout;
  ListUrl next = url;
  for (int i = 0; i <= kMaxListRedirects; ++i) {
    auto download = std::make_unique<Download>(tls);
    const auto result = download->run(next, std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()));
    const HttpResponseReader& answer = download->exchange->answer();
    if (result.end == End::kTimedOut) dropLater(std::move(download));
    if (result.end != End::kAnswered) return problemOf(inWords(result));
    if (answer.status() == 200) return answer.body();
    if (!isRedirect(answer.status())) return problemOf("HTTP status " + std::to_string(answer.status()));
    const auto target = next.redirected(answer.head().value("location"));
    if (!target) return problemOf("redirect to an address that is not https");
    next = *target;
  }
  return problemOf("too many redirects");
}

}  // namespace naiad
