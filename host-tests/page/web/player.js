// A recording or a table that is shown: its views in time, and the bar to move in it.

import { endRecorded, pace, showRecorded } from "choices";
import { TOUCHING } from "firmware";
import { along } from "recording";

const by = (id) => document.getElementById(id);

export class Player {
  constructor() {
    this.close();
    by("play").addEventListener("click", () => {
      this.plays = !this.plays;
      by("play").textContent = this.plays ? "pause" : "play";
    });
    by("time").addEventListener("input", () => (this.at = Number(by("time").value)));
  }

  /** Shows a recording from its beginning. */
  open(recording) {
    Object.assign(this, { recording, at: 0, plays: true });
    by("play").textContent = "pause";
    by("time").max = recording.views.length - 1;
    by("timeline").hidden = false;
    by("device").disabled = true;
    by("device-about").textContent = recording.with ? `This run was made with ${recording.with}.` : "";
    if (recording.settings) showRecorded(recording.settings);
    by("proven").hidden = false;
    by("proven").textContent = recording.hash
      ? `✓ A run of ${recording.on}: here it comes to the same state hash ${recording.hash}, bit for bit.`
      : `The places of ${recording.title}${recording.with ? `, made with ${recording.with}` : ""}, with the settings here.`;
  }

  /** Renders a table again, with other settings. */
  again(device, rate) {
    if (this.recording?.places) this.recording = along(this.recording, device, rate);
  }

  /** From where its surface looks at the stylus, most of all. */
  get front() {
    const sum = [0, 0, 0];
    for (const { contact, normal } of this.recording.views)
      if (contact === TOUCHING) normal.forEach((part, axis) => (sum[axis] += part));
    const length = Math.hypot(...sum) || 1;
    return sum.map((part) => part / length);
  }

  /** Stands at a time, s. */
  seek(seconds) {
    Object.assign(this, { plays: false, at: seconds / this.recording.seconds });
    by("play").textContent = "play";
  }

  /** Leaves it. */
  close() {
    this.recording = null;
    endRecorded();
    by("device").disabled = false;
    by("timeline").hidden = by("proven").hidden = true;
  }

  /** The view after so many seconds more. */
  advance(seconds) {
    const { views, seconds: apart } = this.recording;
    if (this.plays) this.at = (this.at + (seconds * pace()) / apart) % views.length;
    by("time").value = Math.floor(this.at);
    by("clock").textContent = `${(this.at * apart).toFixed(2)} s`;
    return views[Math.floor(this.at)];
  }
}
