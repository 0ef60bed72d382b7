#include "mission_control/request_parser.hpp"

#include "common/bus/config.hpp"
#include "corpus.hpp"
#include "mission_control/command.hpp"
#include "mission_control/request_guard.hpp"
#include "parsers.hpp"

namespace rover::fuzz {
namespace {

using mission::RequestParser;

void run_request(const Input& input, Scratch&) {
  const std::string_view bytes = input.bytes;
  RequestParser parser;
  // Cut into pieces as a network may.
  const size_t piece = 1 + bytes.size() % 97;
  for (size_t at = 0; at < bytes.size() && parser.state() < RequestParser::State::kWhole; at += piece)
    parser.feed(bytes.substr(at, piece));
  if (parser.state() < RequestParser::State::kWhole) parser.end({408, "too slow"});
  const mission::Request& request = parser.request();
  mission::check_request({}, mission::facts_of(request));
  const auto command = mission::parse_command(request.body, {});
  mission::parse_points(request.body, {});
  if (parser.state() == RequestParser::State::kRefused) throw ConfigError(parser.refusal().reason);
  if (!command.command) throw ConfigError(command.error);
}

}  // namespace

Parser requests_parser() {
  return {"requests",
          files_of("requests"),
          {"\r\n",
           "\r\n\r\n",
           "\n",
           "\r",
           ": ",
           "Content-Length: 5\r\n",
           "Transfer-Encoding: chunked\r\n",
           "%00",
           "%zz",
           "%2e%2e/",
           "?",
           "&",
           "=",
           ";",
           "HTTP/9.9",
           "0\r\n",
           "ffffffffffffffff\r\n",
           "{",
           "[",
           "\"",
           "\\u0000",
           "null"},
          run_request};
}

}  // namespace rover::fuzz
