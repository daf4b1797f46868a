// Frames between a palpate device and a C# host (docs/reference/wire.md), without Unity's types: a record read from the
// device, and the messages that greet it, keep the link alive, stop it and push. Tested on the documents' own frames.

using System;
using System.Collections.Generic;

namespace Palpate
{
    /// <summary>The loop at a tick, as the device's telemetry reports it. SI units, the device's frame.</summary>
    public struct Record
    {
        public uint Tick;
        /// <summary>0 reset, 1 calibrate, 2 armed, 3 running, 4 fault.</summary>
        public byte Phase;
        /// <summary>0, or a number of docs/reference/faults.md.</summary>
        public byte Fault;
        /// <summary>Signed distance to the surface, m.</summary>
        public float Gap;
        /// <summary>Position of the probe, m: x, y, z.</summary>
        public float[] Probe;
        /// <summary>Rendered force, N: x, y, z.</summary>
        public float[] Force;
    }

    /// <summary>Takes bytes as they come, and gives the payload of each whole frame.</summary>
    public sealed class Receiver
    {
        private readonly List<byte> frame = new List<byte>();

        /// <summary>Frames that were damaged.</summary>
        public int Damaged { get; private set; }

        /// <summary>The payload that ends with this byte, or null.</summary>
        public byte[] Feed(byte next)
        {
            if (next != 0)
            {
                // No frame is longer; more is a line without an end.
                if (frame.Count < 512) frame.Add(next);
                return null;
            }
            byte[] payload = frame.Count == 0 ? null : Unpack(frame);
            if (frame.Count != 0 && payload == null) Damaged += 1;
            frame.Clear();
            return payload;
        }

        private static byte[] Unpack(List<byte> frame)
        {
            var bytes = new List<byte>();
            for (int at = 0; at < frame.Count;)
            {
                int run = frame[at++];
                if (at + run - 1 > frame.Count) return null;
                for (int i = 1; i < run; i += 1) bytes.Add(frame[at++]);
                if (run < 255 && at < frame.Count) bytes.Add(0);
            }
            int length = bytes.Count - 4;
            if (length < 1) return null;
            byte[] payload = bytes.GetRange(0, length).ToArray();
            return BitConverter.ToUInt32(bytes.ToArray(), length) == Frames.Checksum(payload) ? payload : null;
        }
    }

    /// <summary>Messages as frames, and payloads as records.</summary>
    public static class Frames
    {
        /// <summary>The wire's version of this file: a device of another one must not be commanded.</summary>
        public const byte Version = 5;

        /// <summary>Greets the device.</summary>
        public static byte[] Hello() { return Pack(new byte[] { 5, Version }); }

        /// <summary>The host is there; at least every third of the device's link timeout.</summary>
        public static byte[] Alive() { return Pack(new byte[] { 0 }); }

        /// <summary>Stops the motors; latched. No emergency stop.</summary>
        public static byte[] Stop() { return Pack(new byte[] { 1 }); }

        /// <summary>A force on the probe, N, in the device's frame; it lasts 0.1 s and ramps.</summary>
        public static byte[] Push(uint number, float x, float y, float z)
        {
            var payload = new List<byte> { 6 };
            Var(payload, number);
            payload.Add(9);
            foreach (float component in new[] { x, y, z }) payload.AddRange(BitConverter.GetBytes(component));
            return Pack(payload.ToArray());
        }

        /// <summary>A record, or null if the payload is another message.</summary>
        public static Record? AsRecord(byte[] payload)
        {
            int at = 0;
            try
            {
                if (Var(payload, ref at) != 1) return null;
                var record = new Record { Tick = Var(payload, ref at) };
                // number, clock, began, shortest, longest, took, dropped
                for (int i = 0; i < 7; i += 1) Var(payload, ref at);
                record.Phase = payload[at++];
                record.Fault = payload[at++];
                Var(payload, ref at); // fault_tick
                at += 1; // reset
                for (int i = 0; i < 3; i += 1) Var(payload, ref at); // overruns, bridged, bad_frames
                at += 4; // gains, hold
                Var(payload, ref at); // feature
                at += 2; // mode, contact
                record.Gap = Float(payload, ref at);
                record.Probe = new[] { Float(payload, ref at), Float(payload, ref at), Float(payload, ref at) };
                record.Force = new[] { Float(payload, ref at), Float(payload, ref at), Float(payload, ref at) };
                for (int i = 0; i < 3; i += 1) Var(payload, ref at); // duties
                return at == payload.Length ? record : (Record?)null;
            }
            catch (IndexOutOfRangeException)
            {
                return null;
            }
        }

        /// <summary>A payload with its checksum, in COBS, with its end.</summary>
        public static byte[] Pack(byte[] payload)
        {
            var bytes = new List<byte>(payload);
            bytes.AddRange(BitConverter.GetBytes(Checksum(payload)));
            bytes.Add(0);
            var frame = new List<byte>();
            for (int at = 0; at < bytes.Count;)
            {
                int end = bytes.IndexOf(0, at);
                frame.Add((byte)(end - at + 1));
                frame.AddRange(bytes.GetRange(at, end - at));
                at = end + 1;
            }
            frame.Add(0);
            return frame.ToArray();
        }

        /// <summary>CRC-32 (IEEE 802.3).</summary>
        public static uint Checksum(byte[] bytes)
        {
            uint crc = 0xffffffff;
            foreach (byte next in bytes)
            {
                crc ^= next;
                for (int bit = 0; bit < 8; bit += 1) crc = (crc & 1) == 1 ? (crc >> 1) ^ 0xedb88320 : crc >> 1;
            }
            return ~crc;
        }

        private static void Var(List<byte> bytes, uint number)
        {
            for (; number > 127; number >>= 7) bytes.Add((byte)(number | 128));
            bytes.Add((byte)number);
        }

        private static uint Var(byte[] bytes, ref int at)
        {
            uint number = 0;
            for (int shift = 0; ; shift += 7)
            {
                byte next = bytes[at++];
                number |= (uint)(next & 127) << shift;
                if (next < 128) return number;
            }
        }

        private static float Float(byte[] bytes, ref int at)
        {
            if (at + 4 > bytes.Length) throw new IndexOutOfRangeException();
            at += 4;
            return BitConverter.ToSingle(bytes, at - 4);
        }
    }
}
