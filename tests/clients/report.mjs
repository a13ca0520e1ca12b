// report.mjs - what is expected, counted; what is not so, said. And facet, run.
import { execFileSync } from 'node:child_process';

export class Report {
    count = 0;
    failures = 0;

    expect(is_so, sentence) {
        this.count++;
        if (is_so) return true;
        if (++this.failures <= 40) console.log(`FAILED: ${sentence}`);
        return false;
    }

    // |value - wanted| at most tolerance.
    near(value, wanted, tolerance, what) {
        return this.expect(Math.abs(value - wanted) <= tolerance, `${what}: ${value}, not ${wanted} within ${tolerance}`);
    }

    // Ends the process with what was found.
    end(what) {
        console.log(`${what}: ${this.count} checks, ${this.failures} failed`);
        process.exit(this.failures || !this.count ? 1 : 0);
    }
}

// facet bake with args; its sentence where it fails.
export const baker = (facet) => (...args) => {
    try {
        execFileSync(facet, ['bake', '-q', ...args.map(String)], { stdio: ['ignore', 'pipe', 'pipe'] });
    } catch (error) {
        throw new Error(`facet bake ${args.join(' ')}: ${error.stderr || error.message}`);
    }
};
