#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/transport/TransportFactory.h>

#include <pybind11/stl.h>

#include <cstdlib>
#include <set>
#include <sstream>

#include "Module.h"
#include "Node.h"
#include "Values.h"
#include "WaitableModule.h"

namespace Rabit::Python
{
namespace
{

// The settings of a file, or of a text in its form, or of both: the text's entries follow those of the file,
// and settings that the text has (`given`) replace those of the file.
GatewayConfig ReadConfig(const std::string &file, const std::string &node, const std::string &text,
                         const std::set<std::string> &given)
{
    if (file.empty())
    {
        return ParseGatewayConfig(text, "", node);
    }
    GatewayConfig config = LoadGatewayConfig(file, node);
    const GatewayConfig added = ParseGatewayConfig(text, "", config.Node);
    const auto append = [](auto &to, const auto &from) { to.insert(to.end(), from.begin(), from.end()); };
    append(config.Publish, added.Publish);
    append(config.Subscribe, added.Subscribe);
    append(config.Accept, added.Accept);
    append(config.Send, added.Send);
    append(config.Foreign, added.Foreign);
    append(config.Panels, added.Panels);
    append(config.ProblemsOf, added.ProblemsOf);
    const auto replace = [&](const char *key, auto GatewayConfig::*member)
    {
        if (given.count(key) != 0)
        {
            config.*member = added.*member;
        }
    };
    replace("domain", &GatewayConfig::Domain);
    replace("transport", &GatewayConfig::Transport);
    replace("interfaces", &GatewayConfig::Interfaces);
    replace("peers", &GatewayConfig::Peers);
    replace("multicast", &GatewayConfig::Multicast);
    replace("max_datagram", &GatewayConfig::MaxDatagram);
    replace("shared_memory", &GatewayConfig::SharedMemory);
    replace("lease", &GatewayConfig::Lease);
    replace("lost_after", &GatewayConfig::LostAfter);
    replace("backend_config", &GatewayConfig::BackendConfig);
    replace("security", &GatewayConfig::Security);
    replace("radio", &GatewayConfig::Radio);
    replace("paths", &GatewayConfig::Paths);
    replace("state_dir", &GatewayConfig::StateDir);
    replace("parameters", &GatewayConfig::Parameters);
    replace("record", &GatewayConfig::Record);
    replace("fetch", &GatewayConfig::Fetch);
    replace("agreement", &GatewayConfig::Agreement);
    replace("reports", &GatewayConfig::Reports);
    ValidateGatewayConfig(config);
    return config;
}

// With the interfaces, the folder of recordings and the keys of the environment, as a node in C++ has them
// (NodeOptions): the lab runs each node in a network of its own.
GatewayConfig ConfigOf(const std::string &file, const std::string &node, const std::string &text,
                       const std::set<std::string> &given)
{
    GatewayConfig config = ReadConfig(file, node, text, given);
    if (const char *interfaces = std::getenv("RABIT_NODE_INTERFACE");
        interfaces != nullptr && *interfaces != 0)
    {
        std::vector<std::string> names;
        std::istringstream list(interfaces);
        for (std::string name; std::getline(list, name, ',');)
        {
            names.push_back(name);
        }
        UseInterfaces(names, config);
    }
    if (const char *folder = std::getenv("RABIT_NODE_RECORD"); folder != nullptr && *folder != 0)
    {
        if (!config.Record)
        {
            config.Record.emplace();
        }
        config.Record->Folder = folder;
    }
    if (const char *keys = std::getenv("RABIT_NODE_KEYS"); keys != nullptr && *keys != 0)
    {
        config.Security.emplace().Keys = keys;
        for (PathRule &path : config.Paths)
        {
            path.Security.reset();
        }
    }
    return config;
}

// The handle of a manager for Python, which may outlive the manager.
struct ManagerCore
{
    std::shared_ptr<PythonManager *> Manager;
    RabitHandler Wake;

    PythonManager &Use() const
    {
        if (*Manager == nullptr)
        {
            throw std::runtime_error("the node of this manager was stopped");
        }
        return **Manager;
    }
};

void DefineReceived(py::module_ &module)
{
    py::class_<Received>(module, "Received")
        .def_readonly("value", &Received::Value)
        .def_readonly("node", &Received::Node)
        .def_readonly("message", &Received::Message)
        .def_property_readonly("age", &Received::Age)
        .def_property_readonly("stamp", &Received::Stamp)
        .def("__repr__", [](const Received &self)
             { return "<" + self.Message + " " + py::cast<std::string>(py::repr(self.Value)) + ">"; });
    py::class_<ReceivedCommand>(module, "Command")
        .def_readonly("value", &ReceivedCommand::Value)
        .def_readonly("queue", &ReceivedCommand::Queue)
        .def_readonly("redelivered", &ReceivedCommand::IsRedelivered)
        .def("__repr__", [](const ReceivedCommand &self)
             { return "<" + self.Queue + " " + py::cast<std::string>(py::repr(self.Value)) + ">"; });
}

// The functions of both streams.
template <class Stream, class Class>
void DefineStream(Class &stream)
{
    DefineWaits<Stream>(stream);
    stream.def("take", &Stream::Take)
        .def_property_readonly("is_closed", &Stream::IsClosed)
        .def("close", &Stream::Close);
}

}  // namespace

void DefineNode(py::module_ &module)
{
    DefineReceived(module);
    py::class_<Subscription, std::shared_ptr<Subscription>> subscription(module, "Subscription");
    DefineStream<Subscription>(subscription);
    subscription.def_property_readonly("name", &Subscription::Name).def("all", &Subscription::All);
    py::class_<InboundQueue, std::shared_ptr<InboundQueue>> queue(module, "Queue");
    DefineStream<InboundQueue>(queue);
    queue.def_property_readonly("name", &InboundQueue::Name)
        .def_property_readonly("waiting", &InboundQueue::Waiting);

    py::class_<Receipt, std::shared_ptr<Receipt>>(module, "Receipt")
        .def_property_readonly("number", &Receipt::Number)
        .def_property_readonly("address", &Receipt::Address)
        .def_property_readonly("outcome",
                               [](const Receipt &self) { return static_cast<int>(self.Outcome()); })
        .def_property_readonly("reason", &Receipt::Reason)
        .def_property_readonly("counts",
                               [](const Receipt &self)
                               {
                                   const auto counts = self.Counts();
                                   return py::make_tuple(counts.Pending, counts.Delivered, counts.Expired,
                                                         counts.InDoubt, counts.Refused);
                               })
        .def("tell_loop", &Receipt::TellLoop)
        .def("wait", &Receipt::Wait);

    py::class_<ManagerCore>(module, "ManagerCore")
        .def("wake", [](const ManagerCore &self) { self.Wake(); })
        .def_property_readonly("is_turn", [](const ManagerCore &self)
                               { return *self.Manager != nullptr && (*self.Manager)->IsTurn(); })
        .def("wake_on",
             [](const ManagerCore &self, const std::string &name, const MessageClass &type)
             {
                 const std::shared_ptr<RabitMessage> message = type.Registered->CreateShared();
                 if (!self.Use().AddPublishSubscribeMessage(name, message))
                 {
                     throw py::type_error("the local message `" + name + "` is of another type than " +
                                          type.Name());
                 }
                 self.Use().WakeUpManagerOnMessagePost(message);
             })
        .def("wake_on_queue", [](const ManagerCore &self, const InboundQueue &from)
             { self.Use().WakeUpManagerOnEnqueue(from.Local()); })
        .def("wake_on_agreement",
             [](const ManagerCore &self, Agreement &agreement) { agreement.ConnectChanged(self.Wake); });

    py::class_<Node, std::shared_ptr<Node>>(module, "NodeCore")
        .def(py::init([](const std::string &file, const std::string &node, const std::string &text,
                         const std::set<std::string> &given)
                      { return std::make_shared<Node>(ConfigOf(file, node, text, given)); }))
        .def_property_readonly("name", &Node::Name)
        .def_property_readonly("is_running", &Node::IsRunning)
        .def_property_readonly("has_threads", &Node::HasThreads)
        .def_property_readonly("accepts",
                               [](const Node &self)
                               {
                                   std::vector<std::string> names;
                                   for (const AcceptRule &rule : self.Config().Accept)
                                   {
                                       names.push_back(rule.Queue);
                                   }
                                   for (const ForeignRule &rule : self.Config().Foreign)
                                   {
                                       if (rule.Way == ForeignRule::Direction::Subscribe &&
                                           rule.Each == ForeignRule::Delivery::Queue)
                                       {
                                           names.push_back(rule.Local);
                                       }
                                   }
                                   return names;
                               })
        .def("add_queue", &Node::AddQueue)
        .def("add_manager",
             [](Node &self, const std::string &name, const py::object &object, double period)
             {
                 PythonManager &manager = self.AddManager(name, object, period);
                 return ManagerCore{manager.Self(), manager.WakeUpHandler()};
             })
        .def("add_library", &Node::AddLibrary)
        .def("start", &Node::Start)
        .def("stop", &Node::Stop)
        .def("subscribe", &Node::Subscribe)
        .def("unsubscribe", &Node::Unsubscribe)
        .def("post", &Node::Post)
        .def("send", &Node::Send)
        .def("fleet", [](Node &self) { return ValueOf(*ClassOf("Rabit::Gateway::Fleet"), self.Fleet()); })
        .def("flush", &Node::Flush)
        .def("messages", &Node::Messages)
        .def("agreement", &Node::Agreed)
        .def("check", &Node::Check)
        .def("check_network", &Node::CheckNetwork)
        .def_property_readonly("outcomes_fd", [](Node &self) { return self.KnownOutcomes()->Ready().Fd(); })
        .def("arm_outcomes", [](Node &self) { self.KnownOutcomes()->Ready().Arm(); })
        .def("take_outcomes",
             [](Node &self)
             {
                 // In this order: what becomes known after Take wakes the loop again.
                 self.KnownOutcomes()->Ready().Drain();
                 self.KnownOutcomes()->Ready().Arm();
                 return self.KnownOutcomes()->Take();
             });
    module.def("load_library", [](const std::string &path) { LoadLibrary(path); });
    module.def("transports", &AvailableTransports);
}

}  // namespace Rabit::Python
