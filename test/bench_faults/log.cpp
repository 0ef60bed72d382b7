#include "test/bench_faults/log.hpp"

#include <set>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover::bench_faults {
namespace {

// Images and the large inputs of the planner would fill the disk.
const std::set<std::string> kLeftOut = {channel::kDisparity, channel::kDone, channel::kServiceState,
                                        channel::kWheelCommand};

}  // namespace

Log::Log(lcm::LCM& bus, const std::string& path) : log_(path) {
  bus.subscribeFunction(
         ".*",
         +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, Log* self) { self->take(buffer, channel); },
         this)
      ->setQueueCapacity(0);
}

void Log::take(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  if (kLeftOut.contains(channel)) return;
  const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
  log_.put_bytes(channel, {bytes, bytes + buffer->data_size}, now_);
}

void Log::note(const char* channel, injection_t what) {
  what.header.utime = what.header.release_utime = now_;
  log_.put_bytes(channel, encoded(what), now_);
}

}  // namespace rover::bench_faults
