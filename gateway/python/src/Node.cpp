#include "Node.h"

#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/recording/RecorderManager.h>

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "Seconds.h"
#include "Values.h"

namespace Rabit::Python
{

Node::Node(GatewayConfig config)
    : _config(std::move(config)),
      _process(getpid()),
      _parts(std::make_shared<Parts>()),
      _agreed(_config.Agreement ? std::make_shared<Agreement>(_config) : nullptr)
{
    _parts->Agreed = _agreed;
    // The names have their types from now on: other uses of them are refused where the program makes them.
    const auto add = [this](const std::string &name, const std::string &type)
    { _parts->Workspace.AddPublishSubscribeMessage(name, MessageTypeRegistry::Find(type)->CreateShared()); };
    for (const PublishRule &rule : _config.Publish)
    {
        add(rule.Message, rule.Type);
    }
    for (const ForeignRule &rule : _config.Foreign)
    {
        if (rule.Each != ForeignRule::Delivery::Queue)
        {
            add(rule.Local, rule.Type);
        }
    }
}

Node::~Node()
{
    if (getpid() != _process)
    {
        new std::shared_ptr<Parts>(_parts);  // never destroyed: its threads are in the other process
        return;
    }
    bool hasEnded = false;
    try
    {
        hasEnded = Stop();
    }
    catch (py::error_already_set &error)  // Ctrl-C
    {
        error.discard_as_unraisable("the end of a node");
    }
    if (!hasEnded)
    {
        new std::shared_ptr<Parts>(_parts);  // never destroyed: a manager still runs
    }
}

std::shared_ptr<Node::Parts> Node::Use()
{
    if (getpid() != _process)
    {
        throw std::runtime_error(
            "the node `" + Name() +
            "` lives in the process that made it; a forked process makes nodes of its own");
    }
    if (!_parts)
    {
        throw StoppedError();
    }
    return _parts;
}

std::runtime_error Node::StoppedError() const
{
    return std::runtime_error("the node `" + Name() + "` was stopped; a node runs once, make another one");
}

std::shared_ptr<Node::Parts> Node::UseNetwork()
{
    auto parts = Use();
    if (parts->Explorer == nullptr)
    {
        throw std::runtime_error("the node `" + Name() + "` does not run yet: use it in a `with` block");
    }
    return parts;
}

std::shared_ptr<InboundQueue> Node::AddQueue(const std::string &name, int capacity)
{
    auto queue = std::make_shared<InboundQueue>(name, capacity);
    const auto held = Use();
    Parts &parts = *held;
    parts.Workspace.AddManagerMessageQueue(name, queue->Local());
    parts.Queues.push_back(queue);
    return queue;
}

PythonManager &Node::AddManager(const std::string &name, const py::object &object, double period)
{
    const auto held = Use();
    Parts &parts = *held;
    if (parts.HasStarted)
    {
        throw std::runtime_error("managers are added before the node starts");
    }
    auto manager = std::make_unique<PythonManager>(name, parts.Workspace, object, period);
    PythonManager &added = *manager;
    parts.Reactor->AddManager(std::move(manager));
    parts.Managers.push_back(&added);
    return added;
}

void *LoadLibrary(const std::string &path)
{
    // The library uses the code that is in this module, and not a copy of its own: so both know the same
    // types.
    Dl_info self{};
    if (dladdr(reinterpret_cast<void *>(&LoadLibrary), &self) == 0 ||
        dlopen(self.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL) == nullptr)
    {
        throw std::runtime_error(std::string("the module cannot be shared: ") + dlerror());
    }
    // Never closed: its managers and types may live until the process ends.
    void *library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr)
    {
        throw std::runtime_error(std::string("the library cannot be loaded: ") + dlerror());
    }
    return library;
}

void Node::AddLibrary(const std::string &path)
{
    using AddManagers = void (*)(RabitReactor &, GatewayConfig &, RabitWorkspace &);
    const auto held = Use();
    Parts &parts = *held;
    void *library = LoadLibrary(path);
    const auto add = reinterpret_cast<AddManagers>(dlsym(library, "rabit_add_managers"));
    if (add == nullptr)
    {
        throw std::runtime_error(path + ": has no function rabit_add_managers");
    }
    const py::gil_scoped_release released;
    add(*parts.Reactor, _config, parts.Workspace);
}

void Node::AttachAll(Parts &parts)
{
    std::vector<std::shared_ptr<Subscription>> open;
    {
        const std::lock_guard lock(parts.Mutex);
        std::erase_if(parts.Subscriptions, [](const auto &weak) { return weak.expired(); });
        for (const auto &weak : parts.Subscriptions)
        {
            if (auto subscription = weak.lock(); subscription && !subscription->Pattern().empty())
            {
                open.push_back(std::move(subscription));
            }
        }
    }
    if (open.empty())
    {
        return;
    }
    for (const FleetExplorer::Node &node : parts.Explorer->Nodes())
    {
        for (const auto &subscription : open)
        {
            if (node.Offers && MatchesPattern(subscription->Pattern(), node.Name) &&
                std::any_of(node.Offers->publishes.begin(), node.Offers->publishes.end(),
                            [&](const auto &offer) { return offer.message == subscription->Message(); }))
            {
                static_cast<void>(subscription->Attach(node.Name));  // the gateway reports another type
            }
        }
    }
}

bool Node::IsForeign(const std::string &name) const
{
    return name.find('/') == std::string::npos || name == FleetMessageNameOf(_config) ||
           std::any_of(_config.Foreign.begin(), _config.Foreign.end(),
                       [&name](const ForeignRule &rule) { return rule.Local == name; });
}

std::shared_ptr<Subscription> Node::Subscribe(const std::string &pattern, const std::string &message,
                                              std::shared_ptr<MessageClass> type)
{
    const auto parts = UseNetwork();
    const std::string whole = pattern.empty() ? message : pattern + "/" + message;
    const bool isLocal = IsForeign(whole) || pattern == Name();
    auto subscription = std::make_shared<Subscription>(
        std::shared_ptr<RabitWorkspace>(parts, &parts->Workspace), isLocal ? "" : pattern,
        isLocal && pattern != Name() ? whole : message, type);
    const bool isOneNode = isLocal || IsNodeName(pattern);
    if (!isLocal && !IsNodePattern(pattern))
    {
        throw py::value_error("`" + pattern + "` is no node name or pattern");
    }
    const SubscribeRule rule{.Message = message, .Type = type->Name(), .From = {pattern}};
    if (!isLocal && parts->Recorder != nullptr)
    {
        parts->Recorder->AddSubscription(rule);
    }
    if (const std::string problem = isOneNode ? subscription->Attach(isLocal ? "" : pattern) : "";
        !problem.empty())
    {
        throw py::type_error(problem);
    }
    if (!isLocal)
    {
        parts->Explorer->Subscribe(rule);
    }
    {
        const std::lock_guard lock(parts->Mutex);
        parts->Subscriptions.push_back(subscription);
    }
    AttachAll(*parts);
    if (parts->IsEnding)
    {
        CloseStreams(*parts);  // a manager subscribes while the node ends
    }
    return subscription;
}

void Node::Unsubscribe(const std::shared_ptr<Subscription> &subscription)
{
    subscription->Close();
}

void Node::Post(const std::string &name, py::handle value)
{
    const std::shared_ptr<MessageClass> type = ClassOf(value);
    if (!type)
    {
        throw py::type_error("post " + name + ": expected a message, not " +
                             py::cast<std::string>(py::repr(value)));
    }
    // May run code of Python, which may post or stop the node.
    const std::vector<std::uint8_t> sample = Encode(*type->Root, value);
    const auto held = Use();
    Parts &parts = *held;
    auto &[known, message] = parts.Posted[name];
    if (!message)
    {
        auto made = type->Registered->CreateShared();
        if (!parts.Workspace.AddPublishSubscribeMessage(name, made))
        {
            parts.Posted.erase(name);
            throw py::type_error("post " + name + ": the message is of another type than " + type->Name());
        }
        known = type;
        message = made;
    }
    if (known != type)
    {
        throw py::type_error("post " + name + ": expected a " + known->Name() + ", not a " + type->Name());
    }
    Assign(*type, sample, *message);
    // With the GIL: two threads must not post one message at once, and handlers here only wake.
    message->PostMessage();
}

std::shared_ptr<Receipt> Node::Send(const std::string &address, py::handle value,
                                    std::optional<double> expire)
{
    const std::shared_ptr<MessageClass> type = ClassOf(value);
    if (!type)
    {
        throw py::type_error("send " + address + ": expected a message, not " +
                             py::cast<std::string>(py::repr(value)));
    }
    const std::shared_ptr<RabitMessage> message = MessageOf(*type, value);
    const auto held = Use();
    Parts &parts = *held;
    if (expire)
    {
        SetExpiry(address, *expire);
    }
    auto receipt = std::make_shared<Receipt>(_nextReceipt++, address, _outcomes);
    const py::gil_scoped_release released;
    parts.Workspace.AddMessageToQueue(address, message, receipt->Local());
    return receipt;
}

void Node::SetExpiry(const std::string &address, double seconds)
{
    const std::size_t slash = address.find('/');
    if (slash == std::string::npos)
    {
        return;  // a queue here has the message at once
    }
    if (!(seconds > 0 && seconds <= 365 * 86400.0))
    {
        throw py::value_error("expire: expected seconds, more than 0 and up to a year, not " +
                              std::to_string(seconds));
    }
    const auto [known, isNew] = _parts->Expires.emplace(address, seconds);
    if (!isNew && known->second != seconds)
    {
        throw py::value_error("messages to " + address + " expire after " + std::to_string(known->second) +
                              " s, as the first one did; all messages to one queue live equally long");
    }
    if (isNew)
    {
        UseNetwork()->Explorer->SetExpiry(
            address.substr(0, slash), address.substr(slash + 1),
            std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(1000 * seconds))));
    }
}

Gateway::Fleet Node::Fleet()
{
    const auto parts = UseNetwork();
    parts->Fleet->FetchMessage();
    return *parts->Fleet;
}

bool Node::Flush(double seconds)
{
    // In pieces, so that Ctrl-C ends it.
    constexpr std::chrono::nanoseconds piece = std::chrono::milliseconds(200);
    const auto limit = DurationOf(seconds);
    const auto start = std::chrono::steady_clock::now();
    const auto parts = UseNetwork();
    for (;;)
    {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::nanoseconds left = std::max(limit - (now - start), std::chrono::nanoseconds(0));
        {
            const py::gil_scoped_release released;
            const std::shared_lock lock(parts->InUse);
            if (parts->Explorer == nullptr)
            {
                return false;
            }
            if (parts->Explorer->WaitUntilTaken(std::min(left, piece)))
            {
                return true;
            }
        }
        // It returns early only if the gateway has ended.
        if (left <= piece || std::chrono::steady_clock::now() - now < piece)
        {
            return false;
        }
        if (PyErr_CheckSignals() != 0)
        {
            throw py::error_already_set();
        }
    }
}

std::vector<std::string> Node::Messages()
{
    std::set<std::string> names;
    for (const MessageInfo &info : Use()->Workspace.GetListOfMessages())
    {
        names.insert(info.Name);
    }
    for (const FleetExplorer::Node &node : UseNetwork()->Explorer->Nodes())
    {
        if (node.Offers)
        {
            for (const auto &offer : node.Offers->publishes)
            {
                names.insert(node.Name + "/" + offer.message);
            }
        }
    }
    return {names.begin(), names.end()};
}

std::shared_ptr<Agreement> Node::Agreed()
{
    // A second one is refused, with the section that the configuration lacks.
    return _agreed ? _agreed : std::make_shared<Agreement>(_config);
}

}  // namespace Rabit::Python
