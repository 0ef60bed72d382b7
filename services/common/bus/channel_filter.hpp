// Drops datagrams of the bus in the kernel, before they wake the process: on one multicast port each message reaches
// every process, and most of what a service costs when it does nothing is to wake up and see that it is for others.
#pragma once

#include <linux/filter.h>

#include <string>
#include <vector>

namespace rover {

// Messages larger than a datagram come in fragments, of which only the first names its channel. Of some channels all
// messages fit into one.
constexpr size_t kDatagramBytes = 65'000;
bool fits_a_datagram(const std::string& channel);

// Classic BPF over a UDP datagram: takes messages of these channels, and fragments if one of the channels may need
// them. Datagrams that are not LCM's are dropped.
std::vector<sock_filter> channel_program(const std::vector<std::string>& channels);

// For the sockets of this process that are bound to the UDP port. False if the kernel refuses: a program of many
// channels may exceed net.core.optmem_max. Nothing is filtered then.
bool keep_channels(const std::vector<std::string>& channels, int port);

}  // namespace rover
