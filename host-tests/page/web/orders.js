// Parts of a knob's feel for a device on the line, one after another, each until it is answered.

/** Milliseconds until a frame is sent again, how often in all, and between signs of life. */
const ANSWER = 100,
  TRIES = 5,
  ALIVE = 40;
const GREETING = -1,
  SIGN_OF_LIFE = -2;

const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

export class Orders {
  /** For a device whose bytes `heard` reads, and which `write` sends bytes to; `tell` takes a refusal, or nothing. */
  constructor(device, write, tell) {
    Object.assign(this, { device, write, tell, wanted: new Map(), number: 0, busy: false });
  }

  /** Sets a part; a newer one takes the place of one that waits. */
  set(part, numbers) {
    this.wanted.set(part, numbers);
    if (!this.busy) this.send();
  }

  async send() {
    this.busy = true;
    try {
      await this.until(() => this.device.heardOfKnob().greeted, GREETING, [0, 0, 0, 0, 0], "a greeting");
      // A device that watches its host goes on while the page is there.
      this.alive ??= setInterval(() => this.write(this.device.knobFrame(SIGN_OF_LIFE, [8, 0, 0, 0, 0])), ALIVE);
      while (this.wanted.size) {
        const [part, numbers] = this.wanted.entries().next().value;
        this.wanted.delete(part);
        this.number = (this.number + 1) & 0xffff;
        const { number } = this;
        const isAnswered = () => {
          const heard = this.device.heardOfKnob();
          return heard.number === number && !heard.refused.startsWith("busy");
        };
        await this.until(isAnswered, number, numbers, part);
        const { refused } = this.device.heardOfKnob();
        this.tell(refused && `the device refuses ${part}: ${refused}`);
      }
    } catch (error) {
      this.wanted.clear();
      this.tell(error.message);
    }
    this.busy = false;
  }

  /** Sends a frame until something is so. */
  async until(isSo, number, numbers, what) {
    for (let left = TRIES; left > 0; left -= 1) {
      await this.write(this.device.knobFrame(number, numbers));
      for (let waited = 0; waited < ANSWER; waited += 10) {
        if (isSo()) return;
        await pause(10);
      }
    }
    throw new Error(`the device does not answer to ${what}: is it a knob, of this version?`);
  }

  stop() {
    clearInterval(this.alive);
  }
}
