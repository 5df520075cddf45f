// naiad_capacity_bare: the cost of the sockets alone. Sends datagrams to the sockets of the server's clients,
// with the server's sizes, batches and frequency, from buffers prepared in advance.
//
//   naiad_capacity_bare CORE FOLDER PER-TICK TICKS
//
// naiad_capacity_bots has written FOLDER/sizes and FOLDER/endpoints. PER-TICK is the number of datagrams in a
// tick. Prints `datagrams=… cpu_us=…`.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "../Common.h"

namespace {

constexpr std::size_t kBatch = 64;  // like naiad::kUdpBatch
constexpr std::size_t kMax = 1200;

struct Packet {
  sockaddr_in6 to{};
  iovec part{};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(in6_pktinfo))];
  char bytes[kMax];
};

/// Addresses a packet from 127.0.0.1, like the server's.
void address(Packet& packet, msghdr& header, const std::string& host, std::uint16_t port) {
  packet.to.sin6_family = AF_INET6;
  packet.to.sin6_port = htons(port);
  inet_pton(AF_INET6, ("::ffff:" + host).c_str(), &packet.to.sin6_addr);
  in6_pktinfo from{};
  inet_pton(AF_INET6, "::ffff:127.0.0.1", &from.ipi6_addr);
  header.msg_name = &packet.to;
  header.msg_namelen = sizeof packet.to;
  header.msg_iov = &packet.part;
  header.msg_iovlen = 1;
  header.msg_control = packet.control;
  header.msg_controllen = sizeof packet.control;
  cmsghdr* const message = CMSG_FIRSTHDR(&header);
  message->cmsg_level = IPPROTO_IPV6;
  message->cmsg_type = IPV6_PKTINFO;
  message->cmsg_len = CMSG_LEN(sizeof from);
  std::memcpy(CMSG_DATA(message), &from, sizeof from);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5 || !bench::capacity::pinTo(std::stoi(argv[1]))) return 2;
  const std::string folder = argv[2];
  const auto per_tick = static_cast<std::size_t>(std::stoul(argv[3]));
  const int ticks = std::stoi(argv[4]);
  std::vector<std::size_t> sizes;
  std::ifstream size_file(folder + "/sizes");
  for (std::size_t size = 0; size_file >> size;) sizes.push_back(std::min(size, kMax));
  std::vector<std::string> endpoints;
  std::ifstream endpoint_file(folder + "/endpoints");
  for (std::string line; endpoint_file >> line;) endpoints.push_back(line);
  if (sizes.empty() || endpoints.empty()) return 2;

  std::vector<Packet> packets(endpoints.size());
  std::vector<mmsghdr> headers(endpoints.size());
  for (std::size_t i = 0; i < endpoints.size(); ++i) {
    const std::size_t colon = endpoints[i].find(':');
    address(packets[i], headers[i].msg_hdr, endpoints[i].substr(0, colon),
            static_cast<std::uint16_t>(std::stoi(endpoints[i].substr(colon + 1))));
    packets[i].part = {packets[i].bytes, sizes[i % sizes.size()]};
  }
  const int descriptor = socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int off = 0;
  setsockopt(descriptor, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  sockaddr_in6 any{};
  any.sin6_family = AF_INET6;
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&any), sizeof any) != 0) return 1;
  const int buffer = 4 << 20;
  setsockopt(descriptor, SOL_SOCKET, SO_SNDBUF, &buffer, sizeof buffer);

  std::size_t next = 0;
  std::uint64_t sent = 0;
  const auto start = std::chrono::steady_clock::now();
  const double before = bench::capacity::cpuMicros();
  for (int tick = 0; tick < ticks; ++tick) {
    std::this_thread::sleep_until(start + tick * std::chrono::nanoseconds(1'000'000'000 / 30));
    for (std::size_t left = per_tick; left > 0;) {
      const std::size_t count = std::min({left, kBatch, headers.size() - next});
      const int taken = sendmmsg(descriptor, &headers[next], static_cast<unsigned>(count), 0);
      if (taken <= 0) return 1;
      sent += static_cast<std::uint64_t>(taken);
      left -= static_cast<std::size_t>(taken);
      next = (next + static_cast<std::size_t>(taken)) % headers.size();
    }
  }
  std::printf("datagrams=%llu cpu_us=%.0f\n", static_cast<unsigned long long>(sent),
              bench::capacity::cpuMicros() - before);
  return 0;
}
