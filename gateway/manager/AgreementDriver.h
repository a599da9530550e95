#pragma once

#include <rabit/RabitClock.h>
#include <rabit/RabitHandlerThread.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/RandomSource.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agreement/AgreementHub.h"
#include "agreement/AgreementNode.h"
#include "agreement/TableExchange.h"
#include "gateway.idl.h"
#include "paths/PeersOverPaths.h"
#include "presence/Presence.h"
#include "presence/RecentProblems.h"
#include "wire/AgreementNews.h"

namespace Rabit
{

// Drives the agreement of a gateway: passes beats and frames to the state machines of ../agreement, sends
// what they send, and stores fences. The program's threads reach the state machines through the hub.
//
// Threads: OnFrame is called on the transport's threads; all else is for the gateway's thread.
class AgreementDriver
{
public:
    using Duration = std::chrono::nanoseconds;
    struct Network
    {
        // Sends a frame of the topic rabit/Link to that node alone.
        std::function<void(const std::string &node, std::span<const std::uint8_t> frame)> Send;
        // The path by which frames for that node go.
        std::function<std::size_t(const std::string &node)> PathTo;
        // True if a frame of that size may go to that node now, if it is in no hurry.
        std::function<bool(const std::string &node, std::size_t bytes)> HasRoom;
        // AgreementNews::Group as the node tells it; empty: it is not heard now, or has no agreement.
        std::function<std::optional<std::uint32_t>(const std::string &node)> GroupOf;
    };

    // The first byte of frames, which is no version of the links. The datagram follows.
    static constexpr std::uint8_t FirstByte = 'A';

    // The configuration must have an agreement. All references must outlive the object. `fences`: the file of
    // the highest fence; empty: none. `random` is called once. `wake` makes the gateway's thread call Serve
    // soon; called on any thread. `handlers` calls the program's handlers; may be null. Throws ConfigError if
    // another gateway serves the Claims of this configuration.
    AgreementDriver(const GatewayConfig &config, const RabitClock &clock, std::uint64_t incarnation,
                    std::filesystem::path fences, const RandomSource &random, std::function<void()> wake,
                    RabitHandlerThread *handlers, Network network);
    ~AgreementDriver();
    AgreementDriver(const AgreementDriver &) = delete;
    AgreementDriver &operator=(const AgreementDriver &) = delete;

    void OnFrame(std::string_view node, std::span<const std::uint8_t> frame);

    // Bytes that the next beat would take for all that there is to tell, as BeatFormat::Agreement counts.
    std::size_t NewsSize() const;
    // For the beat that is sent now, in that many bytes at most, but with the digests in any case. Answers
    // without room wait for the next beat.
    AgreementNews News(std::size_t room);
    void OnBeat(const Presence::Served::Agreement &told);
    // After beats have come, and after nodes have gone.
    void LookAt(const PeersOverPaths &peers);
    // Does what is due, and sends it. Returns when to call again at the latest.
    Duration Serve(Duration now);
    // Gives up all claims, and tells the others. The other functions do nothing after it.
    void Leave();

    std::vector<Gateway::Problem> Problems(const PeersOverPaths &peers, Duration now);
    // Frames that were malformed, or found the inbox full.
    std::uint64_t Malformed() const;

private:
    // More than all members send within a pass of the gateway, in bytes; and what one node may have of it.
    static constexpr std::size_t LargestInbox = 256 * 1024;
    static constexpr std::size_t LargestShare = LargestInbox / 8;
    // An entry takes that many bytes besides those of its frame.
    static constexpr std::size_t CostOfEntry = 128;
    // Between two datagrams of tables by one path, and between two looks for room.
    static constexpr Duration TablePace = std::chrono::milliseconds(5);
    // After fences could not be stored.
    static constexpr Duration StoreAgainAfter = std::chrono::seconds(1);
    // Fences begin at so many for each second of the incarnation's counter, so they rise from start to start
    // without a file, too, as long as fewer claims are won. A wall clock of 136 years is within
    // ClaimBallots::LargestLeap.
    static constexpr std::uint64_t FencesOfASecond = 256;

    // Opens the hub with the highest fence that may have been accepted. Throws ConfigError.
    TableCopy &OpenedTable(const GatewayConfig &config, const RandomSource &random);
    void TakeInbox();
    void SendDue();
    // One datagram by each path, where there is room.
    void SendTables();
    // Returns true if that has made answers due.
    bool StoreFences();
    void Send(const AgreementNode::Datagram &datagram);
    void SendTo(const std::string &node, const std::vector<std::uint8_t> &datagram);
    void NoteTable(Duration now);
    // Tells the program what has become of its claims, and of the table.
    void Tell(Duration now);
    std::optional<Duration> NextDue(Duration now);
    // This node, and the members that are heard and have the same list.
    std::size_t Answering() const;

    const Network _network;
    RabitHandlerThread *const _handlers;
    const RabitClock &_clock;
    // Something has come since the last Serve. Shared, since a thread of the program may set it late.
    const std::shared_ptr<std::atomic<bool>> _woken = std::make_shared<std::atomic<bool>>(true);
    const std::function<void()> _wake;
    const std::filesystem::path _fences;  // file of the highest fence; empty: none
    std::string _fenceError;              // of the last read or write, in one line; empty: there was none
    Duration _storeAt{0};                 // not before
    const AgreementSettings _settings;
    const std::uint32_t _group;
    const std::shared_ptr<AgreementHub> _hub;  // opened
    TableExchange _exchange;                   // of the hub's table
    Duration _due{0};
    bool _stoodStill = false;
    bool _hasLeft = false;
    RecentProblems _recent;

    mutable std::mutex _mutex;
    std::vector<std::pair<std::string, std::vector<std::uint8_t>>> _inbox;  // guarded: nodes, datagrams
    std::size_t _inboxBytes = 0;                                            // guarded
    std::map<std::string, std::size_t, std::less<>> _inboxShares;           // guarded: bytes of each node
    std::uint64_t _dropped = 0;                                             // guarded
};

}  // namespace Rabit
