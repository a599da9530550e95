#pragma once

#include <string>
#include <vector>

namespace Rabit::Keys
{

// A topic, and the partitions of a writer or a reader on it. Partitions of a reader may be patterns.
struct TopicAccess
{
    std::string Topic;
    std::vector<std::string> Partitions;
    bool operator==(const TopicAccess &) const = default;
};

// The topics that a node writes and reads, and its domain.
struct Access
{
    int Domain = 0;
    std::vector<TopicAccess> Publish;
    std::vector<TopicAccess> Subscribe;
};

}  // namespace Rabit::Keys
