#include "Relay.h"

#include <array>
#include <asio/ip/tcp.hpp>
#include <asio/ip/udp.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>
#include <deque>
#include <map>
#include <string_view>
#include <vector>

namespace bench::attack {
namespace {

using asio::ip::tcp;
using asio::ip::udp;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxQueued = std::size_t{4} << 20;  // waiting bytes above which reading stops
constexpr std::size_t kMaxHoses = 64;
constexpr int kPortAttempts = 50;

/// A stream: the client's socket and the relay's socket to the server.
class Line : public std::enable_shared_from_this<Line> {
 public:
  Line(asio::io_context& context, std::chrono::milliseconds delay)
      : m_delay(delay), m_halves{Half(context), Half(context)} {}

  tcp::socket& socket(std::size_t end) { return m_halves[end].socket; }
  bool isClosed() const { return m_closed; }

  void start() {
    asio::error_code ignored;
    for (Half& half : m_halves) half.socket.set_option(tcp::no_delay(true), ignored);
    read(0);
    read(1);
  }
  void close() {
    m_closed = true;
    for (Half& half : m_halves) {
      asio::error_code ignored;
      half.socket.close(ignored);
      half.timer.cancel();
    }
  }

 private:
  /// Bytes received from a socket; an empty Chunk is the end of the stream.
  struct Chunk {
    Clock::time_point due;
    std::string bytes;
  };
  struct Half {
    explicit Half(asio::io_context& context) : socket(context), timer(context) {}
    tcp::socket socket;
    asio::steady_timer timer;
    std::deque<Chunk> queue;
    std::size_t queued = 0;
    bool writing = false;
    bool reading = false;
    std::array<char, 16384> buffer{};
  };

  void read(std::size_t from) {
    Half& half = m_halves[from];
    half.reading = true;
    half.socket.async_read_some(
        asio::buffer(half.buffer),
        [self = shared_from_this(), from](const asio::error_code& error, std::size_t size) {
          if (self->m_closed) return;
          Half& source = self->m_halves[from];
          source.reading = false;
          source.queue.push_back({Clock::now() + self->m_delay, std::string(source.buffer.data(), size)});
          source.queued += size;
          if (!error && source.queued < kMaxQueued) self->read(from);
          self->pump(from);
        });
  }

  void pump(std::size_t from) {
    Half& half = m_halves[from];
    if (half.writing || half.queue.empty()) return;
    half.writing = true;
    const auto pass = [self = shared_from_this(), from](const asio::error_code& stopped) {
      if (!stopped && !self->m_closed) self->passOn(from);
    };
    if (half.queue.front().due <= Clock::now()) return pass({});
    half.timer.expires_at(half.queue.front().due);
    half.timer.async_wait(pass);
  }

  void passOn(std::size_t from) {
    Half& half = m_halves[from];
    if (half.queue.front().bytes.empty()) return close();
    asio::async_write(m_halves[1 - from].socket, asio::buffer(half.queue.front().bytes),
                      [self = shared_from_this(), from](const asio::error_code& error, std::size_t size) {
                        if (self->m_closed) return;
                        if (error) return self->close();
                        Half& source = self->m_halves[from];
                        source.queue.pop_front();
                        source.queued -= size;
                        source.writing = false;
                        if (!source.reading && source.queued < kMaxQueued) self->read(from);
                        self->pump(from);
                      });
  }

  std::chrono::milliseconds m_delay;
  bool m_closed = false;
  std::array<Half, 2> m_halves;
};

/// Passes on datagrams of one port of the client.
struct Hose {
  Hose(asio::io_context& context, udp::endpoint whose) : client(std::move(whose)), to_server(context) {}
  udp::endpoint client;
  udp::socket to_server;
  std::array<char, 2048> buffer{};
};

}  // namespace

struct Relay::State : std::enable_shared_from_this<State> {
  State(asio::io_context& io, std::uint16_t port, Options relay_options)
      : context(io),
        options(std::move(relay_options)),
        server(asio::ip::address_v4::loopback(), port),
        source(asio::ip::make_address(options.source)),
        acceptor(io),
        datagrams(io) {}

  void open();
  void accept();
  void connect(const std::shared_ptr<Line>& line);
  void listenToClient();
  void listenToServer(const std::shared_ptr<Hose>& hose);
  Hose* hoseOf(const udp::endpoint& client);
  template <class Send>
  void later(std::string_view packet, Send send);
  void cut();

  asio::io_context& context;
  Options options;
  tcp::endpoint server;
  asio::ip::address source;
  tcp::acceptor acceptor;
  udp::socket datagrams;
  bool is_open = true;
  bool closed = false;
  std::vector<std::shared_ptr<Line>> lines;
  std::map<udp::endpoint, std::shared_ptr<Hose>> hoses;
  udp::endpoint sender;
  std::array<char, 2048> packet{};
};

// Streams and datagrams need equal port numbers.
void Relay::State::open() {
  const auto loopback = asio::ip::address_v4::loopback();
  for (int attempt = 1;; ++attempt) {
    acceptor = tcp::acceptor(context, tcp::endpoint(loopback, 0));
    if (!options.datagrams) return;
    try {
      datagrams = udp::socket(context, udp::endpoint(loopback, acceptor.local_endpoint().port()));
      return;
    } catch (const std::system_error&) {
      if (attempt == kPortAttempts) throw;
    }
  }
}

void Relay::State::accept() {
  auto line = std::make_shared<Line>(context, options.delay);
  acceptor.async_accept(line->socket(0), [self = shared_from_this(), line](const asio::error_code& error) {
    if (error || self->closed) return;
    std::erase_if(self->lines, [](const auto& old) { return old->isClosed(); });
    self->is_open ? self->connect(line) : line->close();
    self->accept();
  });
}

void Relay::State::connect(const std::shared_ptr<Line>& line) {
  lines.push_back(line);
  asio::error_code error;
  line->socket(1).open(tcp::v4(), error);
  if (!error) line->socket(1).bind(tcp::endpoint(source, 0), error);
  if (error) return line->close();
  line->socket(1).async_connect(server, [line](const asio::error_code& refused) {
    if (line->isClosed()) return;
    refused ? line->close() : line->start();
  });
}

template <class Send>
void Relay::State::later(std::string_view bytes, Send send) {
  if (options.delay.count() == 0) return send(std::string(bytes));
  auto timer = std::make_shared<asio::steady_timer>(context, options.delay);
  timer->async_wait(
      [self = shared_from_this(), timer, copy = std::string(bytes), send](const asio::error_code& stopped) {
        if (!stopped && !self->closed && self->is_open) send(copy);
      });
}

Hose* Relay::State::hoseOf(const udp::endpoint& client) {
  const auto found = hoses.find(client);
  if (found != hoses.end()) return found->second.get();
  if (hoses.size() >= kMaxHoses) return nullptr;
  auto hose = std::make_shared<Hose>(context, client);
  asio::error_code error;
  hose->to_server.open(udp::v4(), error);
  if (!error) hose->to_server.bind(udp::endpoint(source, 0), error);
  if (!error) hose->to_server.connect(udp::endpoint(server.address(), server.port()), error);
  if (error) return nullptr;
  hoses[client] = hose;
  listenToServer(hose);
  return hose.get();
}

void Relay::State::listenToClient() {
  datagrams.async_receive_from(asio::buffer(packet), sender,
                               [self = shared_from_this()](const asio::error_code& error, std::size_t size) {
                                 if (self->closed) return;
                                 Hose* p_hose =
                                     !error && self->is_open ? self->hoseOf(self->sender) : nullptr;
                                 if (p_hose != nullptr) {
                                   self->later({self->packet.data(), size},
                                               [hose = self->hoses[self->sender]](const std::string& bytes) {
                                                 asio::error_code ignored;
                                                 hose->to_server.send(asio::buffer(bytes), 0, ignored);
                                               });
                                 }
                                 self->listenToClient();
                               });
}

void Relay::State::listenToServer(const std::shared_ptr<Hose>& hose) {
  hose->to_server.async_receive(
      asio::buffer(hose->buffer),
      [self = shared_from_this(), hose](const asio::error_code& error, std::size_t size) {
        if (self->closed || error == asio::error::operation_aborted) return;
        if (!error && self->is_open) {
          self->later({hose->buffer.data(), size}, [self, hose](const std::string& bytes) {
            asio::error_code ignored;
            self->datagrams.send_to(asio::buffer(bytes), hose->client, 0, ignored);
          });
        }
        self->listenToServer(hose);
      });
}

void Relay::State::cut() {
  for (const auto& line : lines) line->close();
  lines.clear();
}

Relay::Relay(asio::io_context& context, std::uint16_t server_port, const Options& options)
    : m_state(std::make_shared<State>(context, server_port, options)) {
  m_state->open();
  m_state->accept();
  if (options.datagrams) m_state->listenToClient();
}

Relay::~Relay() {
  cut();
  m_state->closed = true;
  asio::error_code ignored;
  m_state->acceptor.close(ignored);
  m_state->datagrams.close(ignored);
  for (const auto& [client, hose] : m_state->hoses) hose->to_server.close(ignored);
}

std::uint16_t Relay::port() const {
  return m_state->acceptor.local_endpoint().port();
}

void Relay::cut() {
  m_state->cut();
}

void Relay::setOpen(bool open) {
  m_state->is_open = open;
}

}  // namespace bench::attack
