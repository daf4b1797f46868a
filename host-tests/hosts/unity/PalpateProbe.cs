// A sketch, not compiled here: moves this object with the probe of a palpate device. PalpateLink.cs reads the frames.
// A device's frame is right-handed with z up, in metres, Unity's left-handed with y up: y and z change places.

using System.IO.Ports;
using Palpate;
using UnityEngine;

public sealed class PalpateProbe : MonoBehaviour
{
    public string port = "/dev/ttyACM0";
    public int baud = 500000;
    private readonly Receiver receiver = new Receiver();
    private SerialPort line;

    private void OnEnable()
    {
        line = new SerialPort(port, baud);
        line.Open();
    }

    private void Update()
    {
        // Telemetry comes without a command: this object only watches, and no link timeout starts.
        while (line.BytesToRead > 0)
        {
            byte[] payload = receiver.Feed((byte)line.ReadByte());
            Record? record = payload == null ? null : Frames.AsRecord(payload);
            if (record is Record now) transform.localPosition = new Vector3(now.Probe[0], now.Probe[2], now.Probe[1]);
        }
    }

    private void OnDisable()
    {
        line.Close();
    }
}
