#include "common/bus/bus_url.hpp"

#include <regex>

#include "common/bus/config.hpp"

namespace rover {
namespace {

constexpr int kReportsAbove = 10000;
constexpr int kLastPort = 65535;
constexpr size_t kLongestUrl = 256;  // std::regex needs stack for each character

}  // namespace

std::optional<BusAddress> parse_udpm(const std::string& url) {
  static const std::regex form(
      R"(udpm://((?:22[4-9]|23[0-9])(?:\.[0-9]{1,3}){3}):([0-9]{1,5})(?:\?(?:(?:ttl|recv_buf_size)=[0-9]{1,10}(?:&|$))*)?)");
  static const std::regex buffer(R"(recv_buf_size=([0-9]{1,10}))");
  std::smatch match;
  if (url.size() > kLongestUrl || !std::regex_match(url, match, form)) return std::nullopt;
  BusAddress address;
  address.group = match[1];
  address.port = std::stoi(match[2]);
  if (std::regex_search(url, match, buffer)) address.receive_buffer = std::stol(match[1]);
  return address;
}

std::string bus_url_problem(const std::string& url) {
  if (!parse_udpm(url)) return "'" + url + "' is not of the form udpm://GROUP:PORT?ttl=0&recv_buf_size=BYTES";
  try {
    reports_url(url);
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

std::string reports_url(const std::string& bus_url) {
  const std::optional<BusAddress> address = parse_udpm(bus_url);
  if (!address) return bus_url;
  if (address->port + kReportsAbove > kLastPort)
    throw ConfigError("'" + bus_url + "': the port has to be " + std::to_string(kLastPort - kReportsAbove) +
                      " or lower; the reports of lockstep go " + std::to_string(kReportsAbove) + " above it");
  const size_t port_at = bus_url.find(':', std::string("udpm://").size()) + 1;
  return bus_url.substr(0, port_at) + std::to_string(address->port + kReportsAbove) +
         bus_url.substr(port_at + std::to_string(address->port).size());
}

}  // namespace rover
