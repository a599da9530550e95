#include "recording/JsonStreams.h"

#include "recording/rerun/StepText.h"

namespace Rabit::JsonStreams
{
namespace
{

// The schema gives each property one plain type, even if its value may be null: Foxglove refuses schemas
// that allow null.
RecordingStream Make(const std::string &node, const std::string &name, const std::string &schema,
                     const std::string &text)
{
    RecordingStream stream;
    stream.Topic = node + "/Recorder/" + name;
    stream.Encoding = "json";
    stream.SchemaName = schema;
    stream.SchemaEncoding = "jsonschema";
    stream.SchemaText = text;
    stream.Metadata = {{"rabit.kind", "recorder"}, {"rabit.node", node}};
    return stream;
}

}  // namespace

RecordingStream Log(const std::string &node)
{
    return Make(node, "Log", "foxglove.Log", R"({"type":"object","title":"foxglove.Log","properties":{
"timestamp":{"type":"object","title":"time","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},
"level":{"type":"integer","description":"1 debug, 2 info, 3 warning, 4 error"},
"message":{"type":"string"},"name":{"type":"string"},"file":{"type":"string"},"line":{"type":"integer"}}})");
}

RecordingStream Managers(const std::string &node)
{
    return Make(node, "Managers", "rabit.ManagerState", R"({"type":"object","properties":{
"manager":{"type":"string"},"state":{"type":"string","description":"startup, running or shutdown"},
"error":{"type":"boolean"},"error_code":{"type":"integer","description":"1 unit of work, 2 startup, 3 shutdown"},
"units_of_work":{"type":"integer"},"longest_unit_of_work_s":{"type":"number"},"missed_turns":{"type":"integer"},
"queues":{"type":"array","items":{"type":"object","properties":{"name":{"type":"string"},"capacity":{"type":"integer"},
"fill":{"type":"integer"},"refused":{"type":"integer"}}}}}})");
}

RecordingStream Clocks(const std::string &node)
{
    return Make(node, "Clocks", "rabit.Clocks", R"({"type":"object","properties":{
"incarnation":{"type":"string","description":"of this node"},
"source_to_log_ns":{"type":"string","description":"from this node's source clock to the log times of this file"},
"peers":{"type":"array","items":{"type":"object","properties":{"node":{"type":"string"},
"incarnation":{"type":"string"},
"source_to_log_ns":{"type":"string","description":"from its source clock to the log times of this file"},
"uncertain_by_ns":{"type":"integer","description":"half a round trip; null: not known"}}}}}})");
}

RecordingStream Outcomes(const std::string &node)
{
    return Make(node, "Outcomes", "rabit.QueueOutcome", R"({"type":"object","properties":{
"id":{"type":"string","description":"its lower 32 bits are the sequence number of the message that was sent"},
"node":{"type":"string"},"queue":{"type":"string"},
"outcome":{"type":"string","description":"delivered, expired, in doubt or refused"},
"reason":{"type":"string"}}})");
}

RecordingStream Events(const std::string &node)
{
    return Make(node, "Events", "rabit.Event", R"({"type":"object","properties":{
"event":{"type":"string","description":"the event that started the black box, such as a post or a refused message"}}})");
}

RecordingStream Steps(const std::string &node, const std::string &manager)
{
    RecordingStream stream = Make(node, "Steps/" + manager, "rabit.ManagerStep", Rerun::StepSchema());
    stream.Metadata["rabit.manager"] = manager;
    return stream;
}

}  // namespace Rabit::JsonStreams
