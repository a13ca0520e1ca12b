// explorer_worker.js - plots, computed beside the page: {id, method, args} of Tools is answered by {id, result} or {id, error}.
import { loadTools } from './facet-viewer/tools.js';

const loading = loadTools();

addEventListener('message', async ({ data: { id, method, args } }) => {
  try {
    const tools = await loading;
    postMessage({ id, result: await tools[method](...args) });
  } catch (error) {
    postMessage({ id, error: error.message });
  }
});
