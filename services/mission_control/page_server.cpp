#include "mission_control/page_server.hpp"

#include <cmath>
#include <fstream>
#include <iterator>

#include "mission_control/page_files.hpp"

namespace rover::mission {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr auto kReplyTimeout = 3s;        // for the acknowledgement of a command
constexpr size_t kSpareConnections = 48;  // in addition to one stream per page

// Forbids foreign sources, frames and cross-origin reads.
const Response::Headers kHeaders = {
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'; "
     "base-uri 'none'; form-action 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-cache"}};

using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

Response ok(const json& body) {
  return json_response(200, body);
}

Response picture(const Bytes& bytes, const char* type) {
  return {200, type, {{reinterpret_cast<const char*>(bytes->data()), bytes->size()}, bytes}};
}

int status_of(CommandReply::Outcome outcome) {
  switch (outcome) {
    case CommandReply::Outcome::kAccepted:
      return 200;
    case CommandReply::Outcome::kRefused:
      return 409;
    case CommandReply::Outcome::kBusy:
      return 429;
    case CommandReply::Outcome::kClockStopped:
      return 503;
    case CommandReply::Outcome::kNoReply:
      return 504;
  }
  return 500;
}

std::int64_t number_of(const std::string& text) {
  return std::strtoll(text.c_str(), nullptr, 10);
}

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Exchanges the token in the URL for a cookie.
Response exchange_token(const std::string& token, const Request& request) {
  if (!same_secret(request.param("token"), token)) return refusal({401, "wrong token"});
  return {
      303, "", {}, {{"Location", "/"}, {"Set-Cookie", "rover_token=" + token + "; HttpOnly; SameSite=Strict; Path=/"}}};
}

std::optional<Response> admit(const GuardConfig& guard, const Request& request) {
  if (!guard.token.empty() && request.method == "GET" && request.path == "/" && request.params.contains("token"))
    return exchange_token(guard.token, request);
  const RequestCheck verdict = check_request(guard, facts_of(request));
  if (verdict.status != 200) return refusal(verdict);
  return std::nullopt;
}

ServerLimits limits_of(const PageConfig& config) {
  ServerLimits limits = config.limits;
  limits.connections = static_cast<size_t>(config.max_pages) + kSpareConnections;
  return limits;
}

// Checked before the slopes: a short request could ask for millions of samples.
std::string length_problem(const std::vector<Eigen::Vector2d>& points, double max_length_m) {
  double length_m = 0.0;
  for (size_t i = 0; i + 1 < points.size(); ++i) length_m += (points[i + 1] - points[i]).norm();
  char text[96];
  std::snprintf(text, sizeof text, "the path is %.0f m long; the limit is %.0f m", length_m, max_length_m);
  return length_m > max_length_m ? text : "";
}

}  // namespace

PageServer::PageServer(PageConfig config, PageContext context, SharedState& shared, lcm::LCM& bus)
    : config_(std::move(config)),
      context_(std::move(context)),
      shared_(shared),
      subscriber_(bus, clients_, context_.services),
      map_(context_.run_dir, config_.path.slope, context_.rover_length_m),
      server_(limits_of(config_), kHeaders, [this](const Request& request) { return admit(config_.guard, request); }),
      broadcaster_(clients_, subscriber_, shared_, [this] { server_.wake_streams(); }) {
  add_files();
  add_state();
  add_pictures();
  add_commands();
}

PageServer::~PageServer() {
  clients_.close();
  broadcaster_.stop();
  server_.stop();
}

void PageServer::start() {
  server_.start(config_.guard.address, config_.guard.port, [this](bool served) { shared_.page_is_served = served; });
}

void PageServer::add_files() {
  for (const PageFile& file : page_files()) {
    server_.get(file.path, [&file](const Request&) -> Response { return {200, file.type, {file.content, nullptr}}; });
  }
  for (const LibraryFile& file : library_files()) {
    server_.get("/lib" + file.path, [&file](const Request&) -> Response {
      std::string content = content_of(file.file);
      if (content.empty()) return refusal({404, file.file + " is missing; ./rover build installs it"});
      return {200, file.type, Content::of(std::move(content))};
    });
  }
}

void PageServer::add_state() {
  server_.get("/api/setup", [this](const Request&) { return ok(setup()); });
  server_.get("/api/history", [this](const Request&) { return ok(history()); });
  server_.get("/api/events", [this](const Request& request) {
    const std::int64_t after = number_of(request.param("after"));
    return ok(shared_.book.with([after](const Logbook& book) { return book.events_after(after); }));
  });
  server_.get("/api/paths", [this](const Request&) {
    const LocalPathView local = subscriber_.with([](const TelemetryStore& store) { return store.path(); });
    json global = shared_.book.with([](const Logbook& book) { return book.path_json(); });
    return ok({{"global", global},
               {"local", {{"id", local.id}, {"kind", local.kind}, {"x_m", local.x_m}, {"y_m", local.y_m}}}});
  });
  server_.get("/api/camera", [this](const Request&) { return ok(camera()); });
  server_.get("/api/stream", [this](const Request& request) { return stream(request); });
}

void PageServer::add_pictures() {
  for (const std::string name : {"hazards", "traversability", "elevation"})
    server_.get("/layer/" + name + ".png", [this, name](const Request&) {
      const auto content = subscriber_.with([&](const TelemetryStore& store) { return store.grid(name); });
      return content ? picture(images_.grid(name, *content), "image/png") : refusal({404, "not received yet"});
    });
  for (const std::string name : {"loccam", "navcam"})
    server_.get("/camera/" + name + ".jpg", [this, name](const Request&) {
      const auto image = subscriber_.with([&](const TelemetryStore& store) { return store.image(name); });
      return image ? picture(images_.camera(name, *image), "image/jpeg") : refusal({404, "not received yet"});
    });
  for (const std::string name : {"relief", "slope", "difficulty"})
    server_.get("/map/" + name, [this, name](const Request&) {
      const Bytes bytes = map_.picture(name);
      if (!bytes) return refusal({404, "there is no orbital map"});
      return picture(bytes, name == "relief" ? "image/jpeg" : "image/png");
    });
}

void PageServer::add_commands() {
  server_.post(
      "/api/command", [this](const Request& request) { return command(request); }, HttpServer::Work::kBlocking);
  server_.post("/api/check", [this](const Request& request) { return check(request); });
}

nlohmann::json PageServer::setup() {
  json out = context_.setup;
  out["run"] = context_.run_name;
  out["injection"] = context_.allow_injection;
  out["services"] = context_.services;
  const GroundMap* map = map_.get();
  out["map"] =
      map == nullptr
          ? json()
          : json{{"width_m", map->width_m()}, {"height_m", map->height_m()}, {"resolution_m", map->resolution_m()}};
  out["path"] = {{"corridor_half_width_m", config_.path.corridor_half_width_m},
                 {"steep_slope_deg", std::round(1e6 * to_deg(config_.path.slope.steep_rad)) * 1e-6},
                 {"max_slope_deg", std::round(1e6 * to_deg(config_.path.slope.max_rad)) * 1e-6},
                 {"max_length_m", config_.path.max_length_m},
                 {"max_points", config_.path.limits.max_points}};
  return out;
}

nlohmann::json PageServer::history() {
  return shared_.book.with([](const Logbook& book) {
    return json{{"track", book.track()},
                {"events", book.events_after(0)},
                {"path", book.path_json()},
                {"trend", book.trend_json()}};
  });
}

nlohmann::json PageServer::camera() {
  const auto camera = subscriber_.with([](const TelemetryStore& store) { return store.camera(); });
  if (!camera) return nullptr;
  json rotation = json::array();
  const Eigen::Matrix3d R = camera->T_body_cam.rotation();
  for (int row = 0; row < 3; ++row) rotation.push_back({R(row, 0), R(row, 1), R(row, 2)});
  const Eigen::Vector3d p = camera->T_body_cam.translation();
  return {{"width", camera->width}, {"height", camera->height}, {"focal_px", camera->focal_px},
          {"cx_px", camera->cx_px}, {"cy_px", camera->cy_px},   {"position_m", {p.x(), p.y(), p.z()}},
          {"rotation", rotation}};
}

Response PageServer::stream(const Request& request) {
  const bool truth = request.param("truth") == "1";
  if (!clients_.connect(truth, config_.max_pages)) return refusal({503, "too many pages are open"});
  // The last copy of `next` disconnects the client, however the stream ends.
  const std::shared_ptr<void> connection(nullptr, [this, truth](void*) { clients_.disconnect(truth); });
  Response out{200, "text/event-stream", {}};
  out.next = [this, truth, connection, sent = broadcaster_.newest()]() mutable -> Content {
    const auto frame = broadcaster_.newest();
    if (frame == sent) return {};
    sent = frame;
    return {truth ? frame->view_and_truth : frame->view, frame};
  };
  return out;
}

Response PageServer::command(const Request& request) {
  const ParsedCommand parsed = parse_command(request.body, config_.path.limits);
  if (!parsed.command) return refusal({400, parsed.error});
  if (is_injection(parsed.command->kind)) return inject(*parsed.command);
  if (parsed.command->kind == CommandKind::kPath)
    if (const std::string problem = path_problem(*parsed.command); !problem.empty()) return refusal({422, problem});
  return submit(*parsed.command);
}

Response PageServer::submit(const Command& command) {
  const CommandReply reply = shared_.commands.submit(command, kReplyTimeout);
  const bool accepted = reply.outcome == CommandReply::Outcome::kAccepted;
  return json_response(status_of(reply.outcome),
                       {{"accepted", accepted}, {"reason", reply.reason}, {"command_id", reply.command_id}});
}

Response PageServer::inject(const Command& command) {
  if (!context_.allow_injection)
    return refusal({403, "fault injection is disabled; start with ./rover run --allow-injection"});
  const auto& names = context_.services;
  if (std::find(names.begin(), names.end(), command.target) == names.end())
    return refusal({422, command.target + " is not a service"});
  const bool done = context_.inject(command.target, command.kind);
  shared_.book.with([&](Logbook& book) {
    book.add_event(shared_.now_s, done ? Tone::kWarn : Tone::kInfo, "command",
                   description(command) + (done ? " done" : " failed"));
  });
  if (!done) return refusal({409, "not possible: s6 does not supervise this service"});
  return ok({{"accepted", true}, {"reason", ""}});
}

// A drawn path must stay on the map and below the length and slope limits.
std::string PageServer::path_problem(const Command& command) {
  const GroundMap* map = map_.get();
  if (map == nullptr) return "there is no orbital map to check the path against";
  if (std::string problem = length_problem(command.points, config_.path.max_length_m); !problem.empty()) return problem;
  const PathCheck found = map->check(command.points);
  if (!found.inside) return "the path leaves the map";
  char text[96];
  std::snprintf(text, sizeof text, "the path has a slope of %.1f deg; the limit is %.1f deg",
                to_deg(found.max_slope_rad), to_deg(config_.path.slope.max_rad));
  return found.passable ? "" : text;
}

Response PageServer::check(const Request& request) {
  const ParsedPoints parsed = parse_points(request.body, config_.path.limits);
  if (!parsed.error.empty()) return refusal({400, parsed.error});
  const GroundMap* map = map_.get();
  if (map == nullptr) return refusal({422, "there is no orbital map to check the path against"});
  if (const std::string problem = length_problem(parsed.points, config_.path.max_length_m); !problem.empty())
    return refusal({422, problem});
  PathCheck found = map->check(parsed.points);
  for (double& slope : found.slope_rad) slope = to_deg(slope);
  return ok({{"inside", found.inside},
             {"passable", found.passable},
             {"length_m", found.length_m},
             {"max_slope_deg", to_deg(found.max_slope_rad)},
             {"distance_m", found.distance_m},
             {"slope_deg", found.slope_rad},
             {"height_m", found.height_m}});
}

}  // namespace rover::mission
