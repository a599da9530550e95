// rabit fetch: a file of another node, resumed after every interruption.
#include <rabit/RabitMessageQueue.h>
#include <rabit/gateway/RandomSource.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "Command.h"
#include "CommonOptions.h"
#include "FleetSession.h"
#include "OneNode.h"
#include "Output.h"
#include "backfill/FileFetch.h"
#include "backfill/FileHash.h"
#include "backfill/Mail.h"
#include "backfill/Outbox.h"

namespace Rabit::Tool
{
namespace FetchParts
{
namespace
{

using Queue = RabitMessageQueue<std::shared_ptr<RabitMessage>>;

// Longest sleep between two looks, in seconds.
constexpr double FetchLook = 0.2;

struct FetchOptions
{
    CommonOptions Common;
    std::string What;  // NODE:FILE
    std::string To;
    std::string Node;
    std::string File;
};

// The part of the file that is here. It keeps its bytes when this program ends; a part without bytes is
// removed.
class PartFile
{
public:
    explicit PartFile(std::string path) : _path(std::move(path))
    {
        _file = ::open(_path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0640);
        struct stat status
        {
        };
        if (_file < 0 || ::fstat(_file, &status) != 0 || !S_ISREG(status.st_mode))
        {
            Fail();
        }
        _size = static_cast<std::uint64_t>(status.st_size);
    }
    ~PartFile()
    {
        struct stat status
        {
        };
        if (_isHere && ::fstat(_file, &status) == 0 && status.st_size == 0)
        {
            ::unlink(_path.c_str());
        }
        ::close(_file);
    }
    PartFile(const PartFile &) = delete;
    PartFile &operator=(const PartFile &) = delete;

    std::uint64_t Size() const { return _size; }
    void Append(std::span<const std::uint8_t> bytes)
    {
        while (!bytes.empty())
        {
            const ssize_t written = ::write(_file, bytes.data(), bytes.size());
            if (written < 0 && errno != EINTR)
            {
                Fail();
            }
            bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
        }
    }
    void Empty()
    {
        if (::ftruncate(_file, 0) != 0)
        {
            Fail();
        }
    }
    bool HasHash(const Backfill::FileFetch::Facts &facts) const
    {
        return Backfill::HashOf(_file, facts.Size) == facts.Hash;
    }
    // The file appears under that name as a whole, or not at all.
    void Become(const std::string &path)
    {
        if (::fsync(_file) != 0 || ::rename(_path.c_str(), path.c_str()) != 0)
        {
            Fail();
        }
        _isHere = false;
    }

private:
    [[noreturn]] void Fail() const
    {
        throw std::runtime_error(_path + ": " + std::generic_category().message(errno));
    }

    const std::string _path;
    int _file = -1;
    std::uint64_t _size = 0;
    bool _isHere = true;  // under its own name
};

// One fetch from a node that is heard.
class Fetching
{
public:
    Fetching(FleetSession &session, const FetchOptions &options, std::shared_ptr<Backfill::Mail> mail,
             PartFile &part)
        : _session(session),
          _options(options),
          _mail(std::move(mail)),
          _part(part),
          _fetch(options.File, part.Size(), SystemRandom()),
          _outbox(session.Workspace(), RabitQuickHandler([&session] { session.Notify(); }))
    {
        _session.Workspace().AddManagerMessageQueue(Backfill::QueueName, _queue);
        _enqueued = RabitScopedConnection(
            _queue->ConnectSomethingEnqueued(RabitQuickHandler([&session] { session.Notify(); })));
    }

    // Fetches until the file is whole, the node refuses, or the user ends it. Returns the exit code.
    int Run(const Wakeup &wakeup)
    {
        int rounds = 1;
        while (!wakeup.IsInterrupted())
        {
            const std::optional<bool> sendsFiles = SendsFiles();
            if (sendsFiles == false)
            {
                Output::Talk(_options.Node + " sends no files: its configuration has no `fetch`");
                return ProblemFound;
            }
            Turn(sendsFiles.has_value());
            if (!_fetch.Refusal().empty())
            {
                Output::Talk(_options.Node + ": " + _fetch.Refusal());
                return ProblemFound;
            }
            if (!_wasAccepted && _session.Seconds() >= _options.Common.Wait)
            {
                Output::Talk(_options.Node +
                             " sends no files: its configuration has no `fetch`, or it cannot be reached");
                return ProblemFound;
            }
            if (!_fetch.IsWhole())
            {
                _session.WaitUntil(_session.Seconds() + FetchLook, [this] { return !_queue->IsEmpty(); });
                continue;
            }
            if (_part.HasHash(*_fetch.What()))
            {
                _part.Become(_options.To);
                return Good;
            }
            _part.Empty();
            if (rounds-- == 0)
            {
                Output::Talk(_options.File + " changes on " + _options.Node +
                             " while it is fetched: its hash does not fit");
                return ProblemFound;
            }
            _fetch.StartOver();
        }
        return Interrupted;
    }
    const Backfill::FileFetch &Fetch() const { return _fetch; }

private:
    // By the node's announcement; empty while that has not come.
    std::optional<bool> SendsFiles() const
    {
        const std::vector<FleetSession::Node> nodes = _session.Nodes();
        const FleetSession::Node *const node = FindNode(nodes, _options.Node);
        if (node == nullptr || !node->Offers)
        {
            return std::nullopt;
        }
        const auto &queues = node->Offers->accepts;
        return std::any_of(queues.begin(), queues.end(),
                           [](const Gateway::AcceptedQueue &queue)
                           { return queue.queue == Backfill::QueueName; });
    }
    void Turn(bool maySend)
    {
        const Duration now = std::chrono::steady_clock::now().time_since_epoch();
        const Gateway::Fleet fleet = _session.Fleet();
        if (const Gateway::NodeStatus *node = Gateway::FindNode(fleet, _options.Node))
        {
            _fetch.SetNode(node->incarnation, node->state == Gateway::NodeState::UP, now);
        }
        for (std::shared_ptr<RabitMessage> message; _queue->GetMessage(message);)
        {
            message.reset();  // the same came with its sender's name
        }
        for (const auto &[node, question] : _outbox.TakeFailed())
        {
            _fetch.Failed(question.number, now);
        }
        for (const Backfill::Mail::Letter &letter : _mail->Take())
        {
            if (letter.Answered && letter.Node == _options.Node)
            {
                const std::uint64_t had = _fetch.Have();
                const auto bytes = _fetch.Answered(*letter.Answered, now);
                if (_fetch.Have() < had)
                {
                    _part.Empty();  // the file is shorter than the part
                }
                _part.Append(bytes);
            }
        }
        if (!maySend)
        {
            return;
        }
        for (const Backfill::Question &question : _fetch.Due(now))
        {
            if (_outbox.Send(_options.Node, question))
            {
                _wasAccepted = true;
            }
            else
            {
                _fetch.Failed(question.number, now);
            }
        }
    }

    using Duration = Backfill::FileFetch::Duration;

    FleetSession &_session;
    const FetchOptions &_options;
    const std::shared_ptr<Backfill::Mail> _mail;
    PartFile &_part;
    Backfill::FileFetch _fetch;
    Backfill::Outbox _outbox;
    const std::shared_ptr<Queue> _queue =
        std::make_shared<Queue>(Backfill::QueueCapacity, Backfill::QueueName);
    RabitScopedConnection _enqueued;
    bool _wasAccepted = false;
};

void ShowFetched(const FetchOptions &options, const Backfill::FileFetch &fetch, double seconds)
{
    if (options.Common.Json)
    {
        Output::Object(Json{{"node", options.Node},
                            {"file", options.File},
                            {"to", options.To},
                            {"bytes", fetch.Have()},
                            {"repeated_bytes", fetch.Repeated()},
                            {"seconds", seconds}});
        return;
    }
    char text[64];
    std::snprintf(text, sizeof text, "%.2f MB in %.1f s", static_cast<double>(fetch.Have()) / 1e6, seconds);
    Output::Line(options.To + ": " + text + ", SHA-256 is right");
}

int RunFetch(const FetchOptions &options, Wakeup &wakeup)
{
    // A file that is there is not replaced.
    if (std::filesystem::exists(std::filesystem::symlink_status(options.To)))
    {
        Output::Talk(options.To + " is there already; remove it, or name another file with --to");
        return Usage;
    }
    // Tools accept no queue, and answers come in one.
    GatewayConfig config = ConfigOf(options.Common);
    config.Tool.reset();
    const auto mail = Backfill::Mail::For(config);
    PartFile part(options.To + ".part");
    FleetSession session(config, options.Common, wakeup);
    if (const int code = WaitForNode(session, options.Common, options.Node); code != Good)
    {
        return code;
    }
    Fetching fetching(session, options, mail, part);
    const int code = fetching.Run(wakeup);
    if (code == Good)
    {
        ShowFetched(options, fetching.Fetch(), session.Seconds());
    }
    else if (code == Interrupted && fetching.Fetch().Have() > 0)
    {
        Output::Talk(options.To + ".part has " + std::to_string(fetching.Fetch().Have()) +
                     " bytes; the same command goes on from there");
    }
    return code;
}

}  // namespace
}  // namespace FetchParts

void AddFetchCommand(CLI::App &app, Chosen &chosen)
{
    using namespace FetchParts;
    auto options = std::make_shared<FetchOptions>();
    CLI::App *command = app.add_subcommand("fetch", "Fetch a file of a node, resumed after interruptions");
    command->add_option("FILE", options->What, "A file of a node, as uav1:flight.mcap")->required();
    AddCommonOptions(*command, options->Common, 10.0);
    command->add_option("--to", options->To, "Where it is put (default: its name, in this folder)");
    AddExamples(*command, {"rabit fetch uav1:uav1_000042_20261123T024640Z.mcap",
                           "rabit fetch uav1:map.tif --to maps/uav1.tif",
                           "rabit fetch uav1:flight.log --domain 7 --wait 60"});
    command->callback(
        [options, &chosen]
        {
            const std::size_t colon = options->What.find(':');
            options->Node = options->What.substr(0, colon);
            options->File = colon == std::string::npos ? "" : options->What.substr(colon + 1);
            if (options->Node.empty() || options->File.empty() || options->File.size() > 255)
            {
                throw CLI::ValidationError("FILE", "expected a node and a file, as uav1:flight.mcap");
            }
            options->To =
                options->To.empty() ? std::filesystem::path(options->File).filename().string() : options->To;
            chosen.Run = [options](Wakeup &wakeup) { return RunFetch(*options, wakeup); };
        });
}

}  // namespace Rabit::Tool
