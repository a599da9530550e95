#include <pybind11/stl.h>

#include "Module.h"
#include "Recording.h"

namespace Rabit::Python
{

void DefineRecordings(py::module_ &module)
{
    py::class_<Recording::Messages, std::shared_ptr<Recording::Messages>>(module, "RecordedMessages")
        .def("__iter__", [](py::object self) { return self; })
        .def("__next__", &Recording::Messages::Next)
        .def_property_readonly("problems", &Recording::Messages::Problems)
        .def_property_readonly("undecoded", &Recording::Messages::Undecoded);
    py::class_<Recording, std::shared_ptr<Recording>>(module, "RecordingFile")
        .def(py::init<const std::string &>())
        // Number, topic, type, encoding, messages, metadata.
        .def_property_readonly(
            "channels",
            [](Recording &self)
            {
                py::list channels;
                const Mcap::Contents &contents = self.Contents();
                for (const auto &[number, channel] : contents.Channels)
                {
                    const auto schema = contents.Schemas.find(channel.SchemaId);
                    const auto count = contents.Statistics.ChannelMessageCounts.find(number);
                    channels.append(py::make_tuple(
                        number, channel.Topic, schema == contents.Schemas.end() ? "" : schema->second.Name,
                        channel.MessageEncoding,
                        count == contents.Statistics.ChannelMessageCounts.end() ? 0 : count->second,
                        channel.Metadata));
                }
                return channels;
            })
        .def_property_readonly("metadata",
                               [](Recording &self)
                               {
                                   py::list all;
                                   for (const Mcap::Metadata &metadata : self.Contents().MetadataRecords)
                                   {
                                       all.append(py::make_tuple(metadata.Name, metadata.Values));
                                   }
                                   return all;
                               })
        .def_property_readonly("span",
                               [](Recording &self)
                               {
                                   const Mcap::Statistics &statistics = self.Contents().Statistics;
                                   return py::make_tuple(statistics.StartTime, statistics.EndTime);
                               })
        .def_property_readonly("problems", [](Recording &self) { return self.Contents().Problems; })
        .def("class_of",
             [](Recording &self, std::uint16_t channel)
             {
                 std::string why;
                 const auto type = self.ClassOfChannel(channel, why);
                 return py::make_tuple(
                     type ? py::reinterpret_borrow<py::object>(type->Root->Class) : py::object(py::none()),
                     why);
             })
        .def("messages", [](const std::shared_ptr<Recording> &self, const std::set<std::uint16_t> &channels,
                            std::uint64_t from, std::uint64_t to)
             { return std::make_shared<Recording::Messages>(self, channels, from, to); });
    module.def("merge", &MergeRecordings, py::call_guard<py::gil_scoped_release>());
}

}  // namespace Rabit::Python
