#include "ProcessHarness.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../../Eventually.h"
#include "envelope/Sealer.h"

namespace Paths
{
extern const char *const TransportPeer;
}

namespace Rabit::Conformance
{

namespace
{

// The peer program. It ends by itself when its standard input does, so it cannot outlive the test.
class PeerProcess final : public RemoteNode
{
public:
    explicit PeerProcess(std::vector<std::string> arguments)
    {
        std::array<int, 2> pipe{};
        if (pipe2(pipe.data(), O_CLOEXEC) != 0)
        {
            throw std::runtime_error("pipe failed");
        }
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, pipe[0], STDIN_FILENO);
        std::vector<char *> argv;
        for (auto &argument : arguments)
        {
            argv.push_back(argument.data());
        }
        argv.push_back(nullptr);
        const int error = posix_spawn(&_pid, argv[0], &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(pipe[0]);
        _standardInput = pipe[1];
        if (error != 0)
        {
            close(_standardInput);
            throw std::runtime_error("cannot start " + arguments[0]);
        }
    }
    ~PeerProcess() override
    {
        close(_standardInput);
        Wait();
    }
    void Kill() override
    {
        kill(_pid, SIGKILL);
        Wait();
    }

private:
    void Wait()
    {
        if (_pid > 0)
        {
            waitpid(_pid, nullptr, 0);
            _pid = 0;
        }
    }
    pid_t _pid = 0;
    int _standardInput = -1;
};

}  // namespace

ProcessHarness::ProcessHarness(std::unique_ptr<Transport> backend, std::string fleet)
    : _backend(std::move(backend)), _fleet(std::move(fleet))
{
    if (!_fleet.empty())
    {
        _members.emplace(_fleet);
    }
}

TransportSettings ProcessHarness::SettingsFor(const std::string &node, std::uint64_t incarnation)
{
    TransportSettings settings;
    settings.Node = node;
    settings.Incarnation = incarnation;
    settings.Domain = _domain.Domain();
    settings.Interfaces = {"lo"};
    // Long, so that a slow machine does not lose a peer that lives.
    settings.Lease = std::chrono::seconds(60);
    settings.AnnouncementPeriod = std::chrono::milliseconds(500);
    if (_members)
    {
        settings.Member = _members->Member(node);
    }
    return settings;
}

std::size_t ProcessHarness::MostAdded() const
{
    return _members ? Envelope::Sealer::MostAdded : 0;
}

bool ProcessHarness::Until(const std::function<bool()> &condition)
{
    return RabitTest::Eventually(condition);
}

std::unique_ptr<RemoteNode> ProcessHarness::StartRemote(const std::string &node, std::uint64_t incarnation)
{
    std::vector<std::string> arguments{Paths::TransportPeer, _backend->Name(), node,
                                       std::to_string(incarnation), std::to_string(_domain.Domain())};
    if (_members)
    {
        arguments.push_back(_fleet);
    }
    return std::make_unique<PeerProcess>(std::move(arguments));
}

}  // namespace Rabit::Conformance
