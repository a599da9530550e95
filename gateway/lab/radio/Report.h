#pragma once

#include "Medium.h"

#include <string>

namespace Rabit::Radio
{

// One line of JSON:
//   seconds        since the beginning or the last reset
//   bits_per_s     null: unlimited
//   busy_s         for which something was on the air
//   utilisation    busy_s by seconds, 0 to 1
//   out            whether there is an outage
//   sent           {frames, bytes, ip_bytes} of all nodes; bytes with the overhead, ip_bytes IP packets alone
//   nodes          {name: ...}:
//     offered, dropped, multicast, unicast, heard    {frames, bytes}; NodeCounters.h says what each is
//     ip_bytes, lost, missed, collided, nobody
//     most_in_a_second, most_ip_in_a_second          bytes on the air in the worst second, wherever it begins
//     queued         bytes that wait
//     wait_ms        for which the first of them has waited
//     longest_wait_ms                                of those that were sent
std::string CountersAsJson(const Medium &medium, Time now);

// {node: {kind: [frames, bytes on the air]}}
std::string KindsAsJson(const Medium &medium);

}  // namespace Rabit::Radio
