// Incremental HTTP request parser with bounded memory, on Boost.Beast. It is stricter than the HTTP standard to prevent
// request smuggling.
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
  size_t body_bytes = 64 * 1024;    // more: 413; chunk sizes and extensions may take as much again
};

class RequestParser {
 public:
  enum class State {
    kHeader,   // incomplete header; request() is empty
    kBody,     // incomplete body; the rest of request() is valid
    kWhole,    // request() is complete
    kRefused,  // see refusal()
  };

  explicit RequestParser(const RequestLimits& limits = {});
  ~RequestParser();

  // Adds the next bytes, in pieces of any size. Bytes after the end of the request are ignored.
  State feed(std::string_view bytes);
  // Marks the end of input; an incomplete request is refused with `why`.
  State end(RequestCheck why);

  State state() const { return state_; }
  const Request& request() const { return request_; }
  const RequestCheck& refusal() const { return refusal_; }

 private:
  struct Parsing;

  bool advance();
  bool add_header(bool more_expected);
  bool add_body();
  bool take_whole();
  RequestCheck header_problem() const;
  bool read_header();
  bool refuse(RequestCheck why);

  RequestLimits limits_;
  std::unique_ptr<Parsing> parsing_;
  State state_ = State::kHeader;
  Request request_;
  RequestCheck refusal_;
};

}  // namespace rover::mission
