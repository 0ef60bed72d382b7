// Requests as they are met: whole, cut anywhere, damaged, endless, and such that two programs understand differently.
#include "mission_control/request_parser.hpp"

#include <gtest/gtest.h>

#include <random>

#include "test/wild.hpp"

namespace rover::mission {
namespace {

using State = RequestParser::State;

const std::string kGet = "GET /api/events?after=7 HTTP/1.1\r\nHost: a\r\n";
const std::string kPost = "POST /api/command HTTP/1.1\r\nHost: a\r\n";
const std::string kChunked = kPost + "Transfer-Encoding: chunked\r\n\r\n";

std::string with_length(const std::string& body) {
  return kPost + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

// Status: 200 for a whole request, 0 where more is expected.
int status_of(const RequestParser& parser) {
  if (parser.state() == State::kRefused) return parser.refusal().status;
  return parser.state() == State::kWhole ? 200 : 0;
}

// Fed in pieces of so many bytes.
int status_of(const std::string& bytes, size_t piece = 1'000'000) {
  RequestParser parser;
  for (size_t at = 0; at < bytes.size(); at += piece) parser.feed(std::string_view(bytes).substr(at, piece));
  return status_of(parser);
}

std::string words_of(const RequestParser& parser) {
  return std::to_string(parser.refusal().status) + ": " + parser.refusal().reason;
}

TEST(RequestParser, TargetHeadersAndBodyAreRead) {
  RequestParser parser;
  parser.feed("POST /a%20b/c?after=7&token=x%3d1&flag&after=8 HTTP/1.1\r\nHost: a\r\nX-Two: 1\r\nx-two:  2 \r\n");
  EXPECT_EQ(parser.state(), State::kHeader);
  parser.feed("Content-Length: 5\r\n\r\nhel");
  EXPECT_EQ(parser.state(), State::kBody) << "the header may be judged before the body is there";
  EXPECT_EQ(parser.feed("lo, and what follows"), State::kWhole);
  const Request& request = parser.request();
  EXPECT_EQ(request.method, "POST");
  EXPECT_EQ(request.path, "/a b/c");
  EXPECT_EQ(request.param("after"), "7");
  EXPECT_EQ(request.param("token"), "x=1");
  EXPECT_TRUE(request.params.contains("flag"));
  EXPECT_EQ(request.header("host"), "a");
  EXPECT_EQ(request.header("x-two"), "1, 2");
  EXPECT_EQ(request.body, "hello");
}

TEST(RequestParser, ChunksArePutTogetherHoweverTheyAreCut) {
  const std::string bytes = kChunked + "3\r\nabc\r\n4;name=value\r\ndefg\r\n0\r\nTrailer: x\r\n\r\n";
  for (size_t piece : {1, 2, 3, 5, 1000}) {
    RequestParser parser;
    for (size_t at = 0; at < bytes.size(); at += piece) parser.feed(std::string_view(bytes).substr(at, piece));
    EXPECT_EQ(status_of(parser), 200) << piece;
    EXPECT_EQ(parser.request().body, "abcdefg") << piece;
  }
}

struct Case {
  std::string input;
  std::string bytes;
  int status;
  std::string before;
};

const std::string kFields = [] {
  std::string out;
  for (int i = 0; i < 500; ++i) out += "X-" + std::to_string(i) + ": 1\r\n";
  return out;
}();

std::string many_chunks(const std::string& chunk) {
  std::string out = kChunked;
  while (out.size() < 300'000) out += chunk;
  return out;
}

const std::vector<Case> kCases = {
    {"chunked body of 300 kB", many_chunks("1000\r\n" + std::string(4096, 'x') + "\r\n"), 413,
     "read without limit (60 MB)"},
    {"one header line without an end", "GET / HTTP/1.1\r\nX: " + std::string(300'000, 'x'), 431,
     "read without limit (530 MB)"},
    {"request line without an end (cpp-httplib 2530)", std::string(300'000, 'x'), 431, "read without limit"},
    {"500 header fields", kGet + kFields + "\r\n", 431, "200"},
    {"chunks of one byte, each with an extension of 8 kB (picohttpparser 81, beast 3077)",
     many_chunks("1;x=" + std::string(8000, 'e') + "\r\n \r\n"), 413, "read without limit"},
    {"one chunk size line without an end", kChunked + "1;x=" + std::string(300'000, 'e'), 413, "read without limit"},
    {"trailer without an end", kChunked + "0\r\nX: " + std::string(300'000, 'x'), 413, "read without limit"},
    {"address of 10 kB", "GET /" + std::string(10'000, 'a') + " HTTP/1.1\r\nHost: a\r\n\r\n", 414, "414"},
    {"Content-Length: 65537", kPost + "Content-Length: 65537\r\n\r\n", 413, "413"},
    {"Content-Length: 99999999999999999999", kPost + "Content-Length: 99999999999999999999\r\n\r\n", 400, "413"},
    {"Content-Length: -1", kPost + "Content-Length: -1\r\n\r\n", 400, "413"},
    {"Content-Length: +2 (servicetalk 1427)", kPost + "Content-Length: +2\r\n\r\n{}", 400, "200, taken as 2"},
    {"Content-Length that is empty", kPost + "Content-Length: \r\n\r\n{}", 400, "400"},
    {"two different Content-Length (openlitespeed 395)", kPost + "Content-Length: 2\r\nContent-Length: 0\r\n\r\n{}",
     400, "200, the first counts"},
    {"the same Content-Length twice", kPost + "Content-Length: 2\r\nContent-Length: 2\r\n\r\n{}", 400, "200"},
    {"Content-Length: 2, 2", kPost + "Content-Length: 2, 2\r\n\r\n{}", 400, "200"},
    {"Content-Length, then Transfer-Encoding: chunked (openlitespeed 392)",
     kPost + "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n", 400, "200"},
    {"Transfer-Encoding: chunked, then Content-Length",
     kPost + "Transfer-Encoding: chunked\r\nContent-Length: 2\r\n\r\n2\r\n{}\r\n0\r\n\r\n", 400, "200"},
    {"Transfer-Encoding: gzip, then Content-Length (beast 3098)",
     kPost + "Transfer-Encoding: gzip\r\nContent-Length: 2\r\n\r\n{}", 400, "200, by its length"},
    {"Transfer-Encoding: gzip, chunked (hertz 1490)",
     kPost + "Transfer-Encoding: gzip, chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n", 400, "400, the body is left out"},
    {"Transfer-Encoding: xchunked", kPost + "Transfer-Encoding: xchunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n", 400,
     "400, the body is left out"},
    {"chunk size zz", kChunked + "zz\r\n{}\r\n0\r\n\r\n", 400, "400"},
    {"chunk size -2", kChunked + "-2\r\n{}\r\n0\r\n\r\n", 400, "400"},
    {"chunk size ffffffffffffffff", kChunked + "ffffffffffffffff\r\n{}\r\n0\r\n\r\n", 413, "400"},
    {"chunk size of 17 digits", kChunked + "10000000000000002\r\n{}\r\n0\r\n\r\n", 400, "400"},
    {"chunk longer than its size", kChunked + "2\r\n{}}\r\n0\r\n\r\n", 400, "200"},
    {"header without colon (mongoose 2293)", kGet + "Content-Length 10\r\n\r\n0123456789", 400, "200"},
    {"blank before the colon", kGet + "X : 1\r\n\r\n", 400, "200"},
    {"header without a name", kGet + ": 1\r\n\r\n", 400, "200"},
    {"NUL in a header", kGet + std::string("X: a\0b\r\n\r\n", 10), 400, "200"},
    {"lines that end with LF alone", "GET / HTTP/1.1\nHost: a\n\n", 400, "400"},
    {"two Hosts", kGet + "Host: b\r\n\r\n", 400, "200"},
    {"no Host", "GET / HTTP/1.1\r\n\r\n", 400, "403"},
    {"HTTP/1.0", "GET / HTTP/1.0\r\nHost: a\r\n\r\n", 400, "200"},
    {"HTTP/2 preface", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 400, "400"},
    {"HTTP/0.9", "GET /\r\n\r\n", 400, "400"},
    {"TLS on the plain port", std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11) + "\r\n\r\n", 400, "400"},
    {"the address of a proxy's request", "GET http://a/ HTTP/1.1\r\nHost: a\r\n\r\n", 400, "404"},
    {"OPTIONS *", "OPTIONS * HTTP/1.1\r\nHost: a\r\n\r\n", 400, "405"},
    {"CONNECT a:1", "CONNECT a:1 HTTP/1.1\r\nHost: a\r\n\r\n", 400, "405"},
    {"NUL in the address", "GET /style.css%00.png HTTP/1.1\r\nHost: a\r\n\r\n", 400, "404"},
    {"line break in the address", "GET /?token=a%0d%0aSet-Cookie: HTTP/1.1\r\nHost: a\r\n\r\n", 400, "taken"},
    {"damaged escape in the address", "GET /%zz HTTP/1.1\r\nHost: a\r\n\r\n", 400, "404"},
    {"address that ends in %", "GET /% HTTP/1.1\r\nHost: a\r\n\r\n", 400, "404"},
    {"Expect: the moon", kPost + "Expect: the moon\r\nContent-Length: 2\r\n\r\n{}", 417, "200"},
};

TEST(RequestParser, WrongAndEndlessRequestsAreRefusedHoweverTheyAreCut) {
  for (const Case& wrong : kCases) {
    RequestParser parser;
    parser.feed(wrong.bytes);
    EXPECT_EQ(status_of(parser), wrong.status) << wrong.input << ": " << words_of(parser);
    for (size_t piece : {1, 7, 8192}) {
      const int cut = status_of(wrong.bytes, piece);
      EXPECT_TRUE(cut == wrong.status || (cut == 0 && wrong.status == 400)) << wrong.input << " by " << piece;
    }
    wild_row("The page's server", wrong.input, wrong.before, words_of(parser));
  }
}

TEST(RequestParser, WhatIsCutShortIsRefused) {
  for (const std::string& whole : {kGet + "\r\n", with_length("{}"), kChunked + "2\r\n{}\r\n0\r\n\r\n"}) {
    EXPECT_EQ(status_of(whole), 200);
    for (size_t size = 0; size < whole.size(); ++size) {
      RequestParser parser;
      parser.feed(whole.substr(0, size));
      EXPECT_EQ(status_of(parser), 0);
      parser.end({400, "cut short"});
      EXPECT_EQ(status_of(parser), 400);
      EXPECT_EQ(parser.feed(whole.substr(size)), State::kRefused);
    }
  }
}

TEST(RequestParser, BodiesOf64KiBAreTheLongest) {
  const std::string longest(64 * 1024, 'x');
  EXPECT_EQ(status_of(with_length(longest), 8192), 200);
  EXPECT_EQ(status_of(kChunked + "10000\r\n" + longest + "\r\n0\r\n\r\n", 8192), 200);
  EXPECT_EQ(status_of(with_length(longest + "x"), 8192), 413);
  EXPECT_EQ(status_of(kChunked + "10001\r\n" + longest + "x\r\n0\r\n\r\n", 8192), 413);
}

// HTTP lets a server take a folded line for one with blanks; what counts is that it ends no header.
TEST(RequestParser, FoldedLinesAreOneLine) {
  RequestParser parser;
  parser.feed(kGet + "X: a\r\n b\r\n\r\n");
  EXPECT_EQ(parser.request().header("x"), "a b");
  EXPECT_EQ(status_of(kPost + "Transfer-Encoding:\r\n gzip\r\nContent-Length: 2\r\n\r\n{}"), 400);
}

TEST(RequestParser, ManglingNeverGivesMoreThanItsLimitsAndDoesNotDependOnTheCuts) {
  std::mt19937_64 random(4);
  const std::vector<std::string> good = {kGet + "\r\n", with_length(R"({"command":"go"})"),
                                         kChunked + "3;a=b\r\nabc\r\n1\r\nd\r\n0\r\nT: x\r\n\r\n"};
  static constexpr std::string_view kSigns("\r\n:;,% \t0f-\0\x7f\xff", 15);
  for (int i = 0; i < 20'000; ++i) {
    std::string bytes = good[random() % good.size()];
    for (auto n = random() % 4; n > 0; --n) {
      const size_t at = random() % bytes.size();
      if (random() % 2 == 0)
        bytes[at] = kSigns[random() % kSigns.size()];
      else
        bytes.insert(at, 1, kSigns[random() % kSigns.size()]);
    }
    RequestParser whole, cut;
    whole.feed(bytes);
    for (size_t at = 0; at < bytes.size();) {
      const size_t piece = 1 + random() % 9;
      cut.feed(std::string_view(bytes).substr(at, piece));
      at += piece;
    }
    ASSERT_EQ(whole.state() == State::kWhole, cut.state() == State::kWhole) << bytes;
    ASSERT_EQ(whole.request().body, cut.request().body) << bytes;
    ASSERT_LE(whole.request().body.size(), 64U * 1024U);
  }
}

}  // namespace
}  // namespace rover::mission
