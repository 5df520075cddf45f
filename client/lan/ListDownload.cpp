#include "client/lan/ListDownload.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/version.hpp>
#include <memory>
#include <thread>
#include <utility>

namespace naiad {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace ssl = boost::asio::ssl;
using beast::error_code;
using boost::asio::ip::tcp;

constexpr std::uint32_t kMaxHead = 16 * 1024;

/// One request. Its steps follow each other in callbacks of `context`, which must run until they have ended.
class Request {
 public:
  Request(boost::asio::io_context& context, ssl::context& tls, const ListUrl& url)
      : m_url(url), m_resolver(context), m_stream(context, tls) {
    m_parser.body_limit(kMaxListBytes);
    m_parser.header_limit(kMaxHead);
  }

  void start() {
    m_resolver.async_resolve(m_url.host, std::to_string(m_url.port),
                             [this](error_code error, const tcp::resolver::results_type& results) {
                               if (error) return fail("its host was not found", error);
                               connect(results);
                             });
  }

  bool hasEnded() const { return m_ended; }
  /// Empty, or why there is no answer.
  const std::string& problem() const { return m_problem; }
  const http::response<http::string_body>& answer() const { return m_parser.get(); }

 private:
  void connect(const tcp::resolver::results_type& results) {
    beast::get_lowest_layer(m_stream).async_connect(results, [this](error_code error, const tcp::endpoint&) {
      if (error) return fail("it cannot be reached", error);
      encrypt();
    });
  }
  void encrypt() {
    error_code is_name;
    boost::asio::ip::make_address(m_url.host, is_name);
    if (is_name) SSL_set_tlsext_host_name(m_stream.native_handle(), m_url.host.c_str());  // RFC 6066 3
    m_stream.set_verify_callback(ssl::host_name_verification(m_url.host));
    m_stream.async_handshake(ssl::stream_base::client, [this](error_code error) {
      if (error) return fail("it is not trusted", error);
      ask();
    });
  }
  void ask() {
    m_request.version(11);
    m_request.method(http::verb::get);
    m_request.target(m_url.target);
    m_request.set(http::field::host, m_url.hostText());
    m_request.set(http::field::user_agent, "dfclient");
    m_request.set(http::field::accept, "application/json");
    m_request.set(http::field::connection, "close");
    http::async_write(m_stream, m_request, [this](error_code error, std::size_t) {
      if (error) return fail("it hung up", error);
      http::async_read(m_stream, m_buffer, m_parser, [this](error_code failed, std::size_t) {
        if (failed == http::error::body_limit) return fail("it is longer than 1 MiB", {});
        if (failed) return fail("its answer is cut off, or none of HTTP", failed);
        m_ended = true;
      });
    });
  }
  void fail(const std::string& what, error_code error) {
    m_problem = what + (error ? " (" + error.message() + ")" : "");
    m_ended = true;
  }

  ListUrl m_url;
  tcp::resolver m_resolver;
  beast::ssl_stream<beast::tcp_stream> m_stream;
  beast::flat_buffer m_buffer;
  http::request<http::empty_body> m_request;
  http::response_parser<http::string_body> m_parser;
  std::string m_problem;
  bool m_ended = false;
};

DownloadProblem problemOf(const std::string& what) {
  return {"The list cannot be had: " + what + "."};
}

bool isRedirect(unsigned status) {
  return status == 301 || status == 302 || status == 303 || status == 307 || status == 308;
}

/// A request and what runs it. What has not ended is dropped with the context, after the request.
struct Exchange {
  Exchange(ssl::context& tls, const ListUrl& url) : request(context, tls, url) { request.start(); }

  bool runUntil(std::chrono::steady_clock::time_point end) {
    while (!request.hasEnded() && context.run_one_until(end) > 0) {
    }
    return request.hasEnded();
  }

  boost::asio::io_context context{1};
  Request request;
};

/// A context waits for the system's resolver, which may take long: not us.
void dropLater(std::unique_ptr<Exchange> exchange) {
  std::thread([kept = std::move(exchange)] {}).detach();
}

}  // namespace

std::variant<std::string, DownloadProblem> downloadList(const ListUrl& url) {
  ssl::context tls(ssl::context::tls_client);
  tls.set_default_verify_paths();
  tls.set_verify_mode(ssl::verify_peer);
  const auto end = std::chrono::steady_clock::now() + kListPatience;
  ListUrl next = url;
  for (int i = 0; i <= kMaxListRedirects; ++i) {
    auto exchange = std::make_unique<Exchange>(tls, next);
    if (!exchange->runUntil(end)) {
      dropLater(std::move(exchange));
      return problemOf("it takes longer than 5 s");
    }
    if (!exchange->request.problem().empty()) return problemOf(exchange->request.problem());
    const auto& answer = exchange->request.answer();
    if (answer.result_int() == 200) return answer.body();
    if (!isRedirect(answer.result_int()))
      return problemOf("its host answers with status " + std::to_string(answer.result_int()));
    const auto location = answer[http::field::location];
    const auto target = next.redirected({location.data(), location.size()});
    if (!target) return problemOf("it leads to an address that is not https");
    next = *target;
  }
  return problemOf("it leads from one address to the next");
}

}  // namespace naiad
