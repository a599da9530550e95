#include <rabit/RabitLog.h>
#include <rabit/backfill/BackfillManager.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/idl/NearestWord.h>
#include <rabit/node/RunNode.h>
#include <rabit/recording/RecorderManager.h>
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace Rabit
{
namespace
{

// Logs the published messages that no manager has registered so far. One may still do so in its Startup.
void WarnOfUnknownMessages(const GatewayConfig &config)
{
    std::vector<std::string> names;
    for (const MessageInfo &info : RabitWorkspace::GetWorkspace()->GetListOfMessages())
    {
        names.push_back(info.Name);
    }
    for (const PublishRule &rule : config.Publish)
    {
        if (std::find(names.begin(), names.end(), rule.Message) == names.end())
        {
            RabitLog::Write(RabitLogLevel::Warning,
                            "publish " + rule.Message +
                                ": no manager has registered that message in its constructor" +
                                NearestWordHint(rule.Message, names));
        }
    }
}

}  // namespace

int RunNode(int argc, char **argv, const NodeProgram &program)
{
    CLI::App app(program.Description);
    NodeOptions options;
    options.ConfigFile = program.ConfigFile;
    AddNodeOptions(app, options);
    if (program.AddOptions)
    {
        program.AddOptions(app);
    }
    return RunProgram(
        app, argc, argv,
        [&]
        {
            GatewayConfig config = LoadNodeConfig(options);
            RabitLog::SetName(config.Node);
            RabitReactor reactor;
            program.AddManagers(reactor, config);
            config.Parameters.RefuseOthers();
            WarnOfUnknownMessages(config);
            if (options.Check)
            {
                return 0;
            }
            // The recorder comes before the gateway, which tells it of queue messages.
            RecorderManager *recorder = nullptr;
            if (config.Record)
            {
                auto made = std::make_unique<RecorderManager>(config);
                recorder = made.get();
                reactor.AddManager(std::move(made));
            }
            if (BackfillManager::IsUsed(config))
            {
                reactor.AddManager(std::make_unique<BackfillManager>(config, recorder));
            }
            reactor.AddManager(std::make_unique<GatewayManager>(config, TransportsOf(config, MakeTransport)));
            reactor.Run();  // until a signal
            return 0;
        });
}

int RunNode(int argc, char **argv, const std::string &configFile,
            const std::function<void(RabitReactor &reactor)> &addManagers)
{
    NodeProgram program;
    program.ConfigFile = configFile;
    program.AddManagers = [&addManagers](RabitReactor &reactor, GatewayConfig &) { addManagers(reactor); };
    return RunNode(argc, argv, program);
}

}  // namespace Rabit
