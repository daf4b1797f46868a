// Frames that a test hands over in hexadecimal, a line each: prints the record in them, or packs them again.

using System;
using System.Globalization;
using System.Linq;
using Palpate;

public static class Test
{
    public static void Main()
    {
        Console.WriteLine(Hex(Frames.Hello()));
        Console.WriteLine(Hex(Frames.Alive()));
        Console.WriteLine(Hex(Frames.Stop()));
        Console.WriteLine(Hex(Frames.Push(1, 0, 0, 0.5f)));
        var receiver = new Receiver();
        for (string line; (line = Console.ReadLine()) != null;)
        {
            byte[] payload = null;
            foreach (string pair in line.Split(' ')) payload = receiver.Feed(Convert.ToByte(pair, 16)) ?? payload;
            Record? found = payload == null ? null : Frames.AsRecord(payload);
            if (found == null) { Console.WriteLine("none, damaged " + receiver.Damaged); continue; }
            Record record = found.Value;
            var numbers = new[] { record.Gap }.Concat(record.Probe).Concat(record.Force);
            string text = string.Join(" ", numbers.Select(number => number.ToString("R", CultureInfo.InvariantCulture)));
            Console.WriteLine(record.Tick + " " + record.Phase + " " + record.Fault + " " + text);
        }
    }

    private static string Hex(byte[] bytes) { return string.Join(" ", bytes.Select(each => each.ToString("x2"))); }
}
