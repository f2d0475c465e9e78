// SPDX-License-Identifier: Apache-2.0
// The connection to the program: asks for a message, gives it on, asks for the next (docs/view.md).
import { parseMessage } from "./message.js";

const SHORTEST_PAUSE_MS = 140;
const LONGEST_RETRY_MS = 5000;

// onMessage(head, body); onConnected(true or false). Connects again when the connection is lost.
export function connect(onMessage, onConnected) {
  let retry_ms = 500;
  const open = () => {
    const address = new URL("socket", location.href);
    address.protocol = address.protocol.replace("http", "ws");
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    const ask = () => { if (socket.readyState === WebSocket.OPEN) socket.send("next"); };
    socket.onopen = () => {
      retry_ms = 500;
      onConnected(true);
      ask();
    };
    socket.onmessage = (event) => {
      const { head, body } = parseMessage(event.data);
      onMessage(head, body);
      if (head.more) ask();
      else setTimeout(() => requestAnimationFrame(ask), SHORTEST_PAUSE_MS);  // none in a hidden tab
    };
    socket.onclose = () => {
      onConnected(false);
      setTimeout(open, retry_ms);
      retry_ms = Math.min(2 * retry_ms, LONGEST_RETRY_MS);
    };
  };
  open();
}
