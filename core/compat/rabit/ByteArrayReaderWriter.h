#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace Rabit
{

enum EndianOrder_e
{
    Endian_Little,
    Endian_Big
};

typedef unsigned char byte;

// The byte order of this computer.
EndianOrder_e GetSystemEndianness();

// Writes values one after the other into a buffer that the caller owns and keeps alive, in the given byte
// order. The write functions return true on error (no room), and then write nothing. A negative size or a
// null buffer is taken as a buffer of no bytes. Not thread-safe.
class ByteArrayWriter
{
public:
    ByteArrayWriter(std::uint8_t *byteArray, int size, EndianOrder_e endianOrder);

    std::uint8_t *ByteArray;
    int ByteArraySize;
    int Idx;  // where the next value goes; equals the number of bytes written
    const int MaxStringSize = 65535;

    // Zeroes the buffer and starts again at its beginning.
    void Clear();
    std::uint8_t *GetByteArrayAddrPtrAtIdx() { return ByteArray + Idx; }
    int GetNumberBytesAvailable() { return ByteArraySize > Idx ? ByteArraySize - Idx : 0; }
    // Copies up to NoBytes bytes from data[startIdx] on, limited by the source (arraySize) and by the room
    // left. Returns the number of bytes written.
    int WriteBytes(std::uint8_t data[], int arraySize, int startIdx, int NoBytes);

    bool writeByte(byte value) { return Write(&value, sizeof(value)); }
    bool writeBool(bool value) { return writeUInt8(value ? 1 : 0); }
    bool writeChar(char value) { return Write(&value, sizeof(value)); }
    bool writeInt8(std::int8_t value) { return Write(&value, sizeof(value)); }
    bool writeUInt8(std::uint8_t value) { return Write(&value, sizeof(value)); }
    bool writeInt16(std::int16_t value) { return Write(&value, sizeof(value)); }
    bool writeUInt16(std::uint16_t value) { return Write(&value, sizeof(value)); }
    bool writeInt32(std::int32_t value) { return Write(&value, sizeof(value)); }
    bool writeUInt32(std::uint32_t value) { return Write(&value, sizeof(value)); }
    bool writeInt64(std::int64_t value) { return Write(&value, sizeof(value)); }
    bool writeUInt64(std::uint64_t value) { return Write(&value, sizeof(value)); }
    bool writeFloat(float value) { return Write(&value, sizeof(value)); }
    bool writeDouble(double value) { return Write(&value, sizeof(value)); }
    // A string is its length as uint16, then its bytes; one longer than MaxStringSize is an error.
    bool writeString(const std::string &value);
    bool writeString(const char *value, int length);

private:
    bool Write(const void *value, std::size_t size);
    bool HasRoomFor(std::int64_t bytes) const;

    EndianOrder_e _endianOrder;
};

// Reads what a ByteArrayWriter of the same byte order wrote. If a value does not lie within the buffer,
// reading it returns 0 and leaves the position. The reader never reads outside the buffer. Not thread-safe.
class ByteArrayReader
{
public:
    ByteArrayReader(std::uint8_t *byteArray, int size, EndianOrder_e endianOrder);

    std::uint8_t *ByteArray;
    int ByteArraySize;
    int Idx;
    const int MaxStringSize = 65535;

    // Starts again at the beginning of the buffer, whose contents stay.
    void Clear() { Idx = 0; }
    std::uint8_t *GetByteArrayAddrPtrAtIdx() { return ByteArray + Idx; }
    int GetNumberBytesAvailable() { return ByteArraySize > Idx ? ByteArraySize - Idx : 0; }

    byte readByte() { return ReadValue<byte>(); }
    bool readBool() { return readUInt8() != 0; }
    char readChar() { return ReadValue<char>(); }
    std::int8_t readInt8() { return ReadValue<std::int8_t>(); }
    std::uint8_t readUInt8() { return ReadValue<std::uint8_t>(); }
    std::int16_t readInt16() { return ReadValue<std::int16_t>(); }
    std::uint16_t readUInt16() { return ReadValue<std::uint16_t>(); }
    std::int32_t readInt32() { return ReadValue<std::int32_t>(); }
    std::uint32_t readUInt32() { return ReadValue<std::uint32_t>(); }
    std::int64_t readInt64() { return ReadValue<std::int64_t>(); }
    std::uint64_t readUInt64() { return ReadValue<std::uint64_t>(); }
    float readFloat() { return ReadValue<float>(); }
    double readDouble() { return ReadValue<double>(); }
    // Empty if the string does not lie within the buffer.
    std::string readString();
    // These return true on error, and then leave the target and the position unchanged. The array gets a
    // terminating zero, for which it must have room.
    bool readString(std::string *value);
    bool readString(char value[], int maxSize);

private:
    template <typename T>
    T ReadValue()
    {
        T value{};
        Read(&value, sizeof(value));
        return value;
    }
    // Leaves the value and the position if the value does not lie within the buffer.
    void Read(void *value, std::size_t size);
    int StringLengthAtIdx() const;

    EndianOrder_e _endianOrder;
};

}  // namespace Rabit
