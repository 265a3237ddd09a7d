// Browsers start no worker from a file. There, this one runs the search's in a frame.
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(address) {
      super();
      this.waiting = [];
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      document.body.append(this.frame);
      const inside = this.frame.contentWindow;
      addEventListener("message", ({ source, data }) => {
        if (source === inside) this.dispatchEvent(new MessageEvent("message", { data }));
      });
      this.frame.addEventListener("load", () => {
        const { waiting } = this;
        this.waiting = undefined;
        for (const data of waiting) this.postMessage(data);
      });
      inside.document.write(`<script>postMessage = (data) => parent.postMessage(data, "*");</script>
        <script src="${address}"></script>`);
      inside.document.close();
    }

    postMessage(data) {
      if (this.waiting) this.waiting.push(data);
      else this.frame.contentWindow.dispatchEvent(new MessageEvent("message", { data }));
    }
  };
}
