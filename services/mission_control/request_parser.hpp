// Bytes of a connection to one request, in bounded memory, stricter than HTTP asks for where leniency has let requests
// through that two programs understand differently (request smuggling). Boost.Beast parses.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "mission_control/http_message.hpp"

namespace rover::mission {

struct RequestLimits {
  size_t header_bytes = 16 * 1024;  // request line and header fields; more: 431
  size_t fields = 100;              // more: 431
  size_t target_bytes = 8 * 1024;   // more: 414
  size_t body_bytes = 64 * 1024;    // more: 413; that many again may be chunk sizes and extensions
};

class RequestParser {
 public:
  enum class State {
    kHeader,   // more is expected, request() is empty
    kBody,     // more is expected, request() is complete but for its body
    kWhole,    // request() is complete
    kRefused,  // see refusal()
  };

  explicit RequestParser(const RequestLimits& limits = {});
  ~RequestParser();

  // The next bytes, cut anywhere. Those after the end of the request are ignored.
  State feed(std::string_view bytes);
  // There are no more bytes: what is not whole is refused so.
  State end(Verdict why);

  State state() const { return state_; }
  const Request& request() const { return request_; }
  const Verdict& refusal() const { return refusal_; }

 private:
  struct Parsing;

  bool advance();
  bool add_header(bool more_expected);
  bool add_body();
  bool take_whole();
  Verdict header_problem() const;
  bool read_header();
  bool refuse(Verdict why);

  RequestLimits limits_;
  std::unique_ptr<Parsing> parsing_;
  State state_ = State::kHeader;
  Request request_;
  Verdict refusal_;
};

}  // namespace rover::mission
