#include "mission_control/request_parser.hpp"

#include <algorithm>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <charconv>
#include <optional>

namespace rover::mission {
namespace {

namespace http = boost::beast::http;

// Shortest end of a chunked body. Beast 1.74 aborts on fewer bytes at a time (boostorg/beast pull request 2861).
constexpr size_t kMinChunkedBytes = 5;

std::string text_of(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

// Returns nothing if an escape is invalid or encodes a control character.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    unsigned char c = static_cast<unsigned char>(text[i]);
    if (c == '%') {
      const char* digits = text.data() + i + 1;
      if (i + 2 >= text.size() || std::from_chars(digits, digits + 2, c, 16).ptr != digits + 2) return std::nullopt;
      i += 2;
    }
    if (c < 0x20 || c == 0x7f) return std::nullopt;
    out += static_cast<char>(c);
  }
  return out;
}

// Splits the target into path and query; false if an escape is invalid.
bool read_target(std::string_view target, Request& request) {
  const size_t query = std::min(target.find('?'), target.size());
  const auto path = percent_decoded(target.substr(0, query));
  if (!path) return false;
  request.path = *path;
  for (size_t at = query + 1; at < target.size();) {
    const size_t end = std::min(target.find('&', at), target.size());
    const std::string_view pair = target.substr(at, end - at);
    const size_t equals = std::min(pair.find('='), pair.size());
    const auto name = percent_decoded(pair.substr(0, equals));
    const auto value = percent_decoded(pair.substr(std::min(equals + 1, pair.size())));
    if (!name || !value) return false;
    request.params.emplace(*name, *value);
    at = end + 1;
  }
  return true;
}

RequestCheck verdict_on(const boost::system::error_code& error) {
  if (error == http::error::header_limit) return {431, "the header is too long"};
  if (error == http::error::body_limit) return {413, "the body is too long"};
  return {400, "invalid request: " + error.message()};
}

}  // namespace

struct RequestParser::Parsing {
  http::request_parser<http::string_body> parser;
  std::string pending;      // received, not yet parsed
  size_t header_bytes = 0;  // parsed
  size_t body_bytes = 0;    // parsed, including chunk sizes
};

RequestParser::RequestParser(const RequestLimits& limits) : limits_(limits), parsing_(std::make_unique<Parsing>()) {
  parsing_->parser.header_limit(static_cast<std::uint32_t>(limits.header_bytes));
  parsing_->parser.body_limit(limits.body_bytes);
}

RequestParser::~RequestParser() = default;

RequestParser::State RequestParser::feed(std::string_view bytes) {
  if (state_ == State::kHeader || state_ == State::kBody) {
    parsing_->pending += bytes;
    while (advance()) {
    }
  }
  return state_;
}

RequestParser::State RequestParser::end(RequestCheck why) {
  if (state_ == State::kHeader || state_ == State::kBody) refuse(std::move(why));
  return state_;
}

// Returns true if more can be parsed.
bool RequestParser::advance() {
  auto& [parser, pending, header_bytes, body_bytes] = *parsing_;
  const bool in_header = state_ == State::kHeader;
  if (pending.size() < (!in_header && parser.chunked() ? kMinChunkedBytes : 1)) return false;
  boost::system::error_code error;
  const size_t taken = parser.put(boost::asio::buffer(pending), error);
  pending.erase(0, taken);
  (in_header ? header_bytes : body_bytes) += taken;
  const bool more_expected = error == http::error::need_more;
  if (error && !more_expected) return refuse(verdict_on(error));
  return (in_header ? add_header(more_expected) : add_body()) && !more_expected;
}

bool RequestParser::add_header(bool more_expected) {
  const auto& message = parsing_->parser.get();
  const auto fields = static_cast<size_t>(std::distance(message.begin(), message.end()));
  const size_t waiting = more_expected ? parsing_->pending.size() : 0;
  if (parsing_->header_bytes + waiting > limits_.header_bytes || fields > limits_.fields)
    return refuse({431, "the header is too long"});
  if (!parsing_->parser.is_header_done()) return true;
  if (RequestCheck problem = header_problem(); problem.status != 200) return refuse(std::move(problem));
  if (!read_header()) return refuse({400, "the address has an invalid escape"});
  state_ = State::kBody;
  parsing_->parser.eager(true);
  return !take_whole();
}

bool RequestParser::add_body() {
  if (take_whole()) return false;
  if (parsing_->body_bytes + parsing_->pending.size() > 2 * limits_.body_bytes)
    return refuse({413, "the body is too long"});
  return true;
}

bool RequestParser::take_whole() {
  if (!parsing_->parser.is_done()) return false;
  request_.body = std::move(parsing_->parser.get().body());
  state_ = State::kWhole;
  return true;
}

RequestCheck RequestParser::header_problem() const {
  const auto& message = parsing_->parser.get();
  const auto lengths = message.count(http::field::content_length);
  const auto encodings = message.count(http::field::transfer_encoding);
  if (message.version() != 11) return {400, "HTTP/1.1 is required"};
  if (message.target().size() > limits_.target_bytes) return {414, "the address is too long"};
  if (message.target().empty() || message.target()[0] != '/') return {400, "the address must begin with /"};
  if (message.count(http::field::host) != 1) return {400, "exactly one Host is required"};
  if (lengths + encodings > 1 || message[http::field::content_length].find(',') != std::string_view::npos)
    return {400, "the length of the body is given twice"};
  if (encodings == 1 && !boost::beast::iequals(message[http::field::transfer_encoding], "chunked"))
    return {400, "chunked is the only supported encoding of a body"};
  if (message.count(http::field::expect) > 0 && !boost::beast::iequals(message[http::field::expect], "100-continue"))
    return {417, "100-continue is the only supported expectation"};
  return {};
}

bool RequestParser::read_header() {
  const auto& message = parsing_->parser.get();
  request_.method = text_of(message.method_string());
  for (const auto& field : message) {
    std::string name = text_of(field.name_string());
    for (char& c : name)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    std::string& value = request_.headers[name];
    value += (value.empty() ? "" : ", ") + text_of(field.value());
  }
  const auto target = message.target();
  return read_target({target.data(), target.size()}, request_);
}

bool RequestParser::refuse(RequestCheck why) {
  state_ = State::kRefused;
  refusal_ = std::move(why);
  parsing_.reset();
  return false;
}

}  // namespace rover::mission
