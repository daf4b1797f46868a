"""Telemetry of a palpate device as ROS 2 messages: `python3 ros2_bridge.py PORT`, with the wheel and rclpy installed.

| topic | type | from |
|---|---|---|
| `probe` | geometry_msgs/PointStamped | position of the probe, m |
| `wrench` | geometry_msgs/WrenchStamped | rendered force on the probe, N; no torque |
| `gap` | std_msgs/Float32 | signed distance to the surface, m |
| `fault` | std_msgs/UInt8 | 0, or a number of docs/reference/faults.md |

The node only reads: nothing that it does moves a motor. It has not been run under ROS 2 here; the mapping is tested on a
frame of the documents.
"""

import sys

FRAME = "palpate"


def fill(row, probe, wrench, gap, fault):
    """Writes one record into four messages: `row` has probe, force, gap and fault."""
    for stamped in (probe, wrench):
        stamped.header.frame_id = FRAME
    probe.point.x, probe.point.y, probe.point.z = map(float, row["probe"])
    force = wrench.wrench.force
    force.x, force.y, force.z = map(float, row["force"])
    gap.data = float(row["gap"])
    fault.data = int(row["fault"])


def main():
    import palpate
    import rclpy
    from geometry_msgs.msg import PointStamped, WrenchStamped
    from std_msgs.msg import Float32, UInt8

    rclpy.init()
    node = rclpy.create_node("palpate")
    kinds = {"probe": PointStamped, "wrench": WrenchStamped, "gap": Float32, "fault": UInt8}
    topics = {name: node.create_publisher(kind, name, 10) for name, kind in kinds.items()}
    with palpate.Link(sys.argv[1]) as link:
        while rclpy.ok():
            records = link.read(1, timeout=0.1)
            for index in range(len(records.tick)):
                messages = {name: kind() for name, kind in kinds.items()}
                row = {name: getattr(records, name)[index] for name in ("probe", "force", "gap", "fault")}
                fill(row, *messages.values())
                stamp = node.get_clock().now().to_msg()
                messages["probe"].header.stamp = messages["wrench"].header.stamp = stamp
                for name, message in messages.items():
                    topics[name].publish(message)


if __name__ == "__main__":
    main()
